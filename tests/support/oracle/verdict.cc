// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/oracle/verdict.h"

#include <cstdio>

namespace rayshade {
namespace {

const char* nameOf(Fault fault) {
  constexpr const char* kNames[] = {"none", "phantom", "missed", "pointOff", "selfHit"};
  return kNames[static_cast<int>(fault)];
}

std::string hexadecimal(Vec3 v) {
  char text[120];
  std::snprintf(text, sizeof text, "(%a, %a, %a)", v.x, v.y, v.z);
  return text;
}

}  // namespace

void count(OracleReport& report, const Verdict& verdict, const std::function<std::string()>& story) {
  report.questions += verdict.questions;
  report.worst = std::max(report.worst, verdict.fault == Fault::phantom ? 0 : verdict.distance);
  if (verdict.fault == Fault::none) return;
  ++report.failures;
  if (report.examples.size() < 10) report.examples.push_back(story());
}

std::string story(std::string_view name, std::uint64_t seed, std::uint64_t number, const Bytes& shape,
                  const LocalRay& ray, const Verdict& verdict) {
  char text[300];
  std::snprintf(text, sizeof text, "%.*s seed %llu case %llu: %s at t = %.17g, distance %.3g u M; ray ",
                int(name.size()), name.data(), static_cast<unsigned long long>(seed),
                static_cast<unsigned long long>(number), nameOf(verdict.fault), verdict.t, verdict.distance);
  std::string whole = text + hexadecimal(ray.origin) + " " + hexadecimal(ray.direction) + " shape";
  for (const std::byte b : shape) {
    std::snprintf(text, sizeof text, "%02x", static_cast<unsigned>(b));
    whole += text;
  }
  return whole;
}

}  // namespace rayshade
