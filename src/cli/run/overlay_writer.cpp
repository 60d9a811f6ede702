#include "cli/run/overlay_writer.h"

#include <fmt/format.h>

#include "cli/overlay/overlay.h"
#include "cli/write/snapshot.h"

namespace accrete::cli {

void OverlayWriter::frame(const FrameContext& context) {
  if (every_ <= 0 || context.number % static_cast<std::uint64_t>(every_) != 0 || failure_) return;
  const std::vector<Primitive3d> model = snapshot(context.engine.model(), {});
  const OverlayScene scene{context.frame,
                           rig_,
                           context.motion,
                           context.engine.left_primitives(),
                           context.engine.right_primitives(),
                           context.engine.stereo_matches(),
                           model};
  const auto name = [&context](const char* what) {
    return fmt::format("{}/{:06}_{}.png", kOverlayFolder, context.number, what);
  };
  try {
    folder_.write(name("overview"), draw_overview(scene).png());
    folder_.write(name("primitives"), draw_primitives(scene).png());
    folder_.write(name("matches"), draw_matches(scene).png());
    folder_.write(name("model"), draw_model(scene).png());
  } catch (const Failure& failure) {
    failure_ = failure;
  }
}

}  // namespace accrete::cli
