// For programs that use OpenCV: its matrices as our images and the other way round, without a copy. What is returned is
// valid as long as the pixels it shows. Nothing of the library includes this file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>

#include "accrete/image.h"
#include "accrete/status.h"

namespace accrete::interop {

// How the three channels of a matrix are ordered, which the matrix does not know. OpenCV's own functions make BGR.
enum class ChannelOrder : std::uint8_t { kBgr, kRgb };

// A view of `m`, which may be a part of a larger matrix. kInvalidArgument: empty, or not of two dimensions;
// kUnsupported: other pixels than CV_8UC1 and CV_8UC3. Convert these before: m.convertTo(grey, CV_8U, 255.0 / 65535).
[[nodiscard]] inline Result<ImageView> to_view(const cv::Mat& m, ChannelOrder order = ChannelOrder::kBgr) {
  if (m.dims != 2 || m.empty()) return Status::kInvalidArgument;
  if (m.type() != CV_8UC1 && m.type() != CV_8UC3) return Status::kUnsupported;
  ImageView v;
  v.data = m.data;
  v.width_px = m.cols;
  v.height_px = m.rows;
  v.stride_bytes = static_cast<std::ptrdiff_t>(m.step[0]);
  v.format = m.channels() == 1             ? PixelFormat::kGrey8
             : order == ChannelOrder::kBgr ? PixelFormat::kBgr8
                                           : PixelFormat::kRgb8;
  return v;
}
Result<ImageView> to_view(const cv::Mat&& m, ChannelOrder order = ChannelOrder::kBgr) = delete;

// A header for the pixels of `image`, empty where image.valid() is false. Its channels stay in the order that
// image.format says. The pixels are only borrowed: read them, or clone() them first.
[[nodiscard]] inline cv::Mat to_header(const ImageView& image) {
  if (!image.valid()) return {};
  return cv::Mat(image.height_px, image.width_px, channels(image.format) == 1 ? CV_8UC1 : CV_8UC3,
                 const_cast<std::uint8_t*>(image.data), static_cast<std::size_t>(image.stride_bytes));
}

}  // namespace accrete::interop
