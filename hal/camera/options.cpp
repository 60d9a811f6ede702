#include "camera/options.h"

#include "calibration/calibration.h"
#include "text/sentence.h"

namespace accrete::hal::camera {

Outcome check_options(const LiveOptions& o) {
  const bool two = o.layout == StereoLayout::kTwoDevices;
  const auto bad = [](const std::string& text) -> Outcome { return {Status::kInvalidArgument, text}; };
  if (two && o.right.empty())
    return bad("one camera is named: name the right one, too, or say how one device delivers both images (the layout)");
  if (!two && !o.right.empty())
    return bad(std::string("two cameras are named, but the layout ") + to_string(o.layout) + " is that of one device");
  if (o.buffers < 3 || o.buffers > 32) return bad(std::to_string(o.buffers) + " buffers: give 3 to 32");
  if (o.warm_up_frames < 0 || o.warm_up_frames > 1000)
    return bad(std::to_string(o.warm_up_frames) + " frames to warm up: give 0 to 1000");
  if (o.width_px < 0 || o.height_px < 0 || o.width_px > kMaxImageSide_px || o.height_px > kMaxImageSide_px ||
      (o.width_px == 0) != (o.height_px == 0))
    return bad(size_text(o.width_px, o.height_px) + " is no size of an image: give up to " +
               size_text(kMaxImageSide_px, kMaxImageSide_px) + ", or 0x0 for the calibration's");
  if (o.rate_hz != 0 && !(o.rate_hz >= 0.001 && o.rate_hz <= 100'000))
    return bad(number(o.rate_hz) + " is no frame rate: give 0.001 to 100000 Hz, or 0 for the camera's");
  if (o.pair_tolerance_ns < 0) return bad("a tolerance between the times of two images cannot be negative");
  if (o.reconnect_timeout_ns < 0) return bad("a time to look for a lost camera cannot be negative");
  return {};
}

Outcome read_calibration(const LiveOptions& options, StereoRig& rig, Size& eye) {
  eye = {options.width_px, options.height_px};
  rig = {};
  if (options.calibration.empty()) return {};
  Calibration calibration;
  if (Outcome o = read_calibration_file(options.calibration, KittiPair::kGrey, calibration); !o.ok()) return o;
  rig = calibration.rig;
  if (rig.left.width_px != rig.right.width_px || rig.left.height_px != rig.right.height_px)
    return {Status::kUnsupported,
            calibration.source + " has eyes of different sizes: " + size_text(rig.left.width_px, rig.left.height_px) +
                " and " + size_text(rig.right.width_px, rig.right.height_px)};
  if (rig.left.width_px == 0) return {};
  if (eye.width_px == 0) eye = {rig.left.width_px, rig.left.height_px};
  if (eye.width_px != rig.left.width_px || eye.height_px != rig.left.height_px)
    return {
        Status::kInvalidArgument,
        "an eye shall have " + size_text(eye.width_px, eye.height_px) + " pixels, but " + calibration.source +
            " is for " + size_text(rig.left.width_px, rig.left.height_px) +
            ": use the calibration's size, or calibrate at the other one (one device for both eyes: the size is that "
            "of one eye)"};
  return {};
}

}  // namespace accrete::hal::camera
