// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/program/scene_plan.h"

#include <sstream>
#include <vector>

#include "rayshade/sampling/pixel_rows.h"

namespace rayshade {
namespace {

// Samples as Sampler takes them: see sampling/sampler.h.
void planSamples(ScenePlan& plan, const PictureSpec& picture) {
  const SamplingRules rules = samplingRules(picture, 0, 0);
  const auto width = static_cast<std::uint64_t>(rules.area.width);
  const auto height = static_cast<std::uint64_t>(rules.area.height);
  const auto all = static_cast<std::uint64_t>(rules.cells());
  plan.samplesAtMost = rules.cells();
  plan.samplesAtLeast = rules.refining() ? 1 : plan.samplesAtMost;
  plan.eyeRaysAtLeast = plan.eyeRaysAtMost = width * height * all;
  if (!rules.refining()) return;
  const std::uint64_t border = pixelsAskedForAll(rules);
  const std::uint64_t below =
      rules.rowCount > rules.area.height ? width - 2 : 0;  // the line below the picture
  plan.eyeRaysAtLeast = border * all + width * height - border + below;
  plan.eyeRaysAtMost += below;
}

// Writes "2 sphere, 1 plane" of counts by position in a list of types with keywords; "none" when all are 0.
template <class List, class Counts>
std::string listed(const Counts& counts) {
  std::string text;
  std::size_t position = 0;
  List::forEach([&]<class T>() {
    const std::uint64_t n = counts[position++];
    if (n == 0) return;
    text += (text.empty() ? "" : ", ") + std::to_string(n) + " " + std::string(T::keyword);
  });
  return text.empty() ? "none" : text;
}

// A part of the renderer, and what it has to do with this scene.
struct Part {
  bool used = false;
  std::string name, whenUsed, whenNot;
};

std::vector<Part> partsOf(const ScenePlan& p) {
  const SceneFeatures& f = p.features;
  const auto count = [](std::uint64_t n) { return std::to_string(n); };
  return {
      {p.shadowRays, "shadow rays", "at most " + count(p.shadowRaysPerHit) + " for each hit",
       "no light casts a shadow: none is sent"},
      {p.filteredShadows, "coloured shadows",
       "shadow rays go on through " + count(f.shadowTransparent) + " transparent surfaces",
       "the first thing on its way ends a shadow ray"},
      {p.transmittedRays, "transmitted rays", "with a stack of media",
       "none is sent: nothing is refracted, no media are kept"},
      {p.reflectedRays, "reflected rays", "where something mirrors", "none is sent"},
      {p.attenuation, "attenuation", "a power of the distance for each ray in such a medium",
       "no powers of distances"},
      {p.atmosphericEffects > 0, "atmosphere",
       count(p.atmosphericEffects) + " effects, for each ray outside of media",
       "hits do not keep where their ray began"},
      {f.textureCount() > 0, "textures", listed<AllTextures>(f.textures),
       "surfaces and normals are taken as they are"},
      {f.coordinateTextures > 0, "u and v", "for " + count(f.coordinateTextures) + " textures",
       "not computed"},
      {f.csgOperations > 0, "CSG",
       count(f.csgOperations) + " operations, each with its crossings along a ray", "no lists of crossings"},
      {f.instances + f.csgOperations > 0, "named objects",
       count(f.instances) + " placed; an accelerator for each name", "one accelerator for all"},
      {f.transforms > 0, "transforms", count(f.transforms) + ", joined while the scene is read",
       "rays are followed in the world's space alone"},
      {f.moving > 0, "motion", count(f.moving) + " transforms, evaluated for each ray that asks",
       "transforms are evaluated once"},
      {f.unbounded > 0, "unbounded shapes", count(f.unbounded) + ", offered to every ray",
       "a ray is offered only what is near its way"},
      {p.lens, "lens", "eye rays start on it", "all eye rays start at one point"},
      {p.moments, "shutter", "each sample has its own moment", "all samples of a frame have one moment"},
      {p.gaussian, "pixel filter", "Gaussian", "all samples of a pixel weigh the same"},
      {p.samplesAtLeast < p.samplesAtMost, "adaptive sampling",
       "pixels with little contrast keep their first sample", "every pixel gets all of its samples"},
  };
}

}  // namespace

ScenePlan scenePlan(const SceneFeatures& features, const SceneHead& head) {
  const SceneSettings& settings = head.settings;
  const PictureSpec& picture = head.picture;
  ScenePlan plan;
  plan.features = features;
  plan.area = pixelArea(picture).value_or(PixelArea{});
  plan.frames = picture.frames;
  planSamples(plan, picture);
  plan.jitter = picture.jitter;
  plan.gaussian = picture.filter.gaussian && picture.samplesPerSide > 1;
  plan.lens = head.camera.aperture != 0;
  plan.moments = picture.shutter > 0;

  plan.limits = settings.limits;
  for (const LightSource& light : settings.lights) {
    ++plan.lights[light.kind.index()];
    if (settings.shadows && light.castsShadows)
      plan.shadowRaysPerHit += static_cast<std::uint64_t>(pointsOf(light));
  }
  plan.shadowRays = plan.shadowRaysPerHit > 0;
  plan.filteredShadows = plan.shadowRays && settings.transparentShadows && features.shadowTransparent > 0;
  const bool secondary = settings.limits.maxDepth > 0;
  plan.transmittedRays = secondary && features.transparent > 0;
  // Where nothing is refracted any more, what is transparent reflects.
  plan.reflectedRays = secondary && features.reflecting + features.transparent > 0;
  plan.attenuation = features.attenuating > 0 && (plan.transmittedRays || plan.filteredShadows);
  plan.atmosphericEffects = settings.atmosphere.size();
  return plan;
}

std::string describe(const ScenePlan& p) {
  std::ostringstream out;
  const Color& cutoff = p.limits.cutoff;
  const auto line = [&](const std::string& name) -> std::ostream& {
    out << name << std::string(name.size() < 20 ? 20 - name.size() : 1, ' ');
    return out;
  };
  line("picture") << p.area.width << " x " << p.area.height << " pixels, " << p.frames
                  << (p.frames == 1 ? " frame\n" : " frames, the scene placed anew for each\n");
  line("samples in a pixel");
  if (p.samplesAtLeast < p.samplesAtMost) out << p.samplesAtLeast << " or ";
  out << p.samplesAtMost << (p.jitter ? ", jittered\n" : ", at the corners of their cells\n");
  line("eye rays in a frame");
  if (p.eyeRaysAtLeast < p.eyeRaysAtMost) out << p.eyeRaysAtLeast << " to ";
  out << p.eyeRaysAtMost << ", traced one by one\n";
  line("other rays") << "at most " << p.limits.maxDepth << " in a row, weighing more than " << cutoff.r << " "
                     << cutoff.g << " " << cutoff.b << "\n";
  line("shapes") << listed<AllShapes>(p.features.shapes) << "\n";
  line("lights") << listed<AllLights>(p.lights) << "\n";

  const std::vector<Part> parts = partsOf(p);
  for (const bool used : {true, false}) {
    out << (used ? "\nused\n" : "\nnot used\n");
    for (const Part& part : parts)
      if (part.used == used) line("  " + part.name) << (used ? part.whenUsed : part.whenNot) << "\n";
  }
  return out.str();
}

}  // namespace rayshade
