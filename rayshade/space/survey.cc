// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/space/survey.h"

#include "rayshade/scene/held_bytes.h"

namespace rayshade {
namespace {

WholeThings& of(Survey& survey, Whole kind) { return survey.whole[static_cast<std::size_t>(kind)]; }

}  // namespace

void SurveySink::node(NodeId id, SceneNode node) {
  survey_.moves = survey_.moves || node.transforms.moves();
  if (const std::uint64_t images = imageBytes(node); images > 0) of(survey_, Whole::image).add(images);
  stream_.node(id, std::move(node));
}

void SurveySink::object(SceneObject object) {
  if (const AnyShape* shape = std::get_if<AnyShape>(&object.body))
    if (std::holds_alternative<HeightField>(*shape)) of(survey_, Whole::heightField).add(heldBytes(object));
  stream_.object(std::move(object));
}

void SurveySink::count(const SceneObject& object, const Bounds& bounds,
                       const ObjectStream::Brought& brought) {
  const std::uint64_t bytes = brought.bytes + brought.definition;
  survey_.bytes += bytes;
  if (brought.definition > 0)
    of(survey_, std::holds_alternative<Csg>(object.body) ? Whole::csg : Whole::named).add(brought.definition);
  if (bounds.finite()) survey_.world = join(survey_.world, bounds);
  if (!bounds.empty() && !bounds.finite()) survey_.everywhere += bytes;
  survey_.density.add(bounds);
  survey_.sample.add(bounds);
  survey_.held.add(bounds, static_cast<double>(bytes));
}

}  // namespace rayshade
