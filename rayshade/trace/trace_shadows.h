// Shadow rays on their way to a light: the second half of the core.
//
// An opaque thing anywhere on the way means darkness, whatever else is there.  Transparent ones filter the light at every crossing,
// entry and exit, near to far (shading/shadow.h).  A ray is taken as far as what is local allows: up to its light, or to the
// first block of its walk that is not local and might stand in its way.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/scene/settings.h"
#include "rayshade/shading/shadow.h"
#include "rayshade/trace/trace_rays.h"

namespace rayshade {

// A shadow ray that has something transparent on its way, or goes on elsewhere; written out only then.
struct OpenShadow {
  std::size_t index = 0;  // in its bundle
  ShadowRay shadow;       // what it has been let through, and where it was last
  double limit = 0;       // so far all that is on its way is local
  std::optional<NextBlock> next;
  bool dark = false;
};

// Takes at most kBundleSize shadow rays on.  Segment i is ray i from the last transparent surface that it has crossed to its light;
// before begin[i] nothing counts that is not local (empty: 0).  `through[i]`: what it has been let through, on return what
// arrives from the light, black in darkness.  `shadowOf(i)`: the whole ray.  `open` is room that is used again; on return those
// that go on at their `next`.
template <class ShadowOf>
void traceShadows(LocalSpace& space, std::span<Segment> segments, std::span<const double> begin,
                  const SceneSettings& settings, std::span<Color> through, std::vector<OpenShadow>& open,
                  TraceCounts& counts, ShadowOf&& shadowOf);

// ---- what follows is how

namespace trace_detail {
// Takes rays through the transparent surfaces that are local, all of them together.
void filterShadows(LocalSpace& space, std::vector<OpenShadow>& open, const SceneSettings& settings,
                   TraceCounts& counts);
inline constexpr double kFromTheStart[kBundleSize] = {};
}  // namespace trace_detail

template <class ShadowOf>
void traceShadows(LocalSpace& space, std::span<Segment> segments, std::span<const double> begin,
                  const SceneSettings& settings, std::span<Color> through, std::vector<OpenShadow>& open,
                  TraceCounts& counts, ShadowOf&& shadowOf) {
  open.clear();
  if (segments.empty()) return;
  if (begin.empty()) begin = trace_detail::kFromTheStart;
  LocalOcclusion met = localOcclusion(space, segments, begin, counts);
  if (!settings.transparentShadows) met.opaque |= std::exchange(met.transparent, 0);
  forEachRay(met.opaque, [&](std::size_t i) { through[i] = kBlack; });
  forEachRay((met.transparent | met.open) & ~met.opaque, [&](std::size_t i) {
    const double end = segments[i].tMax;
    std::optional<NextBlock> next;
    if ((met.open >> i & 1) != 0) next = nextBlock(space, segments[i].ray, begin[i], end);
    const bool filtered = (met.transparent >> i & 1) != 0;
    if (!filtered && !next) return;
    // Nothing local is in the way of a ray that is not filtered: its limit is where it is.
    const double limit = !filtered ? 0 : next ? std::min(end, next->tEnter) : end;
    open.push_back({i, shadowOf(i), limit, next, false});
  });
  if (open.empty()) return;
  trace_detail::filterShadows(space, open, settings, counts);
  std::erase_if(open, [&](const OpenShadow& o) {
    if (o.dark) {
      through[o.index] = kBlack;
    } else if (!o.next) {
      through[o.index] = o.shadow.through;
    }
    return o.dark || !o.next;
  });
}

}  // namespace rayshade
