// From the buffers of a device, or of two, to the two images of a frame: split, converted or decoded as far as needed.
#pragma once

#include <span>
#include <string>

#include "accrete/hal/live_source.h"
#include "camera/convert.h"
#include "camera/pairer.h"
#include "image/image_file.h"

namespace accrete::hal::camera {

// The eyes that have a device of their own: one device for both is the left one's.
[[nodiscard]] std::span<const Eye> eyes_of(StereoLayout layout);

// The size of a device's buffer for a given size of an eye, and back; 0 stays 0.
struct Size {
  int width_px = 0, height_px = 0;
};
[[nodiscard]] Size buffer_size(StereoLayout layout, Size eye);
// False where it cannot be divided.
[[nodiscard]] bool eye_size(StereoLayout layout, Size buffer, Size& eye);

// The halves of an image, without copying. Not for kInterleaved, which convert() separates. Precondition: eye_size().
void split(StereoLayout layout, const ImageView& whole, ImageView& left, ImageView& right);

class Eyes {
 public:
  enum class Made : std::uint8_t {
    kCopies,   // the buffers may go back
    kViews,    // the images lie in the buffers
    kDamaged,  // reason() says why
  };
  // Two devices.
  [[nodiscard]] Made pair(const RawImage& left, const RawImage& right, StereoFrame& frame);
  // One device with both images.
  [[nodiscard]] Made split_one(StereoLayout layout, const RawImage& raw, StereoFrame& frame);

  // Of the last kDamaged.
  [[nodiscard]] const std::string& reason() const { return reason_; }
  [[nodiscard]] Eye damaged() const { return damaged_; }

 private:
  [[nodiscard]] Made view(const RawImage& raw, ImageBuffer& buffer, ImageView& image);

  ImageBuffer left_, right_;
  std::string reason_;
  Eye damaged_ = Eye::kLeft;
};

}  // namespace accrete::hal::camera
