#include "scenes/spd/scene_writer.h"

#include "scenes/spd/pov_writer.h"
#include "scenes/spd/rayshade_writer.h"
#include "scenes/spd/tachyon_writer.h"

namespace rayshade::spd {

std::unique_ptr<SceneWriter> makeWriter(const WriterOptions& options, std::ostream& out) {
  if (options.format == "rayshade") return std::make_unique<RayshadeWriter>(out, options.grid);
  if (options.format == "pov") return std::make_unique<PovWriter>(out);
  if (options.format == "tachyon") return std::make_unique<TachyonWriter>(out);
  return nullptr;
}

}  // namespace rayshade::spd
