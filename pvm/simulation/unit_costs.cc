// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/simulation/unit_costs.h"

#include <algorithm>

#include "pvm/simulation/figures.h"

namespace rayshade {

UnitCounts unitsOf(const Report& r) {
  const TraceCounts& c = r.counts;
  const auto count = [](std::uint64_t n) { return static_cast<double>(n); };
  return {count(c.primaryRays + c.transmittedRays + c.reflectedRays),
          count(c.shadowRays),
          count(c.visits),
          count(c.tests),
          count(c.hits),
          count(r.combined - std::min(r.combined, c.hits)),
          count(r.messagesIn),
          count(r.messagesOut),
          count(r.packetsIn + r.packetsOut),
          count(r.bytesIn),
          count(r.bytesOut),
          count(r.cellsServed),
          count(r.cache.fetchedBytes)};
}

double UnitCosts::of(const Report& counted) const {
  const UnitCounts counts = unitsOf(counted);
  double sum = 0;
  for (std::size_t i = 0; i < kUnitCount; ++i) sum += nanoseconds[i] * counts[i];
  return sum;
}

UnitCosts readUnitCosts(const std::string& fileName) {
  UnitCosts costs;
  Figures figures(fileName);
  for (std::size_t i = 0; i < kUnitCount; ++i) costs.nanoseconds[i] = figures.take(kUnitNames[i], 0, 1e9);
  figures.finish();
  return costs;
}

}  // namespace rayshade
