// OpenCV's matrices as our images and back: no pixel is copied, and what cannot be shown is refused.
#include <gtest/gtest.h>

#include <type_traits>
#include <vector>

#include "accrete/interop/opencv.h"

namespace accrete::interop {
namespace {

TEST(OpencvInterop, a_matrix_is_shown_without_a_copy) {
  const cv::Mat grey(4, 6, CV_8UC1, cv::Scalar(9));
  const Result<ImageView> v = to_view(grey);
  ASSERT_TRUE(v.ok());
  EXPECT_TRUE(v.value().valid());
  EXPECT_EQ(v.value().data, grey.data);
  EXPECT_EQ(v.value().width_px, 6);
  EXPECT_EQ(v.value().height_px, 4);
  EXPECT_EQ(v.value().format, PixelFormat::kGrey8);
  EXPECT_EQ(v.value().row(3)[5], 9);
}

TEST(OpencvInterop, a_part_of_a_matrix_keeps_its_stride) {
  cv::Mat colour(8, 10, CV_8UC3, cv::Scalar(1, 2, 3));
  const cv::Mat part = colour(cv::Rect(2, 3, 4, 5));
  colour.at<cv::Vec3b>(7, 5)[1] = 200;  // its last pixel
  const Result<ImageView> v = to_view(part);
  ASSERT_TRUE(v.ok());
  EXPECT_EQ(v.value().stride_bytes, 30);
  EXPECT_EQ(v.value().format, PixelFormat::kBgr8);
  EXPECT_EQ(v.value().row(4)[3 * 3 + 1], 200);
  EXPECT_EQ(to_view(part, ChannelOrder::kRgb).value().format, PixelFormat::kRgb8);

  const cv::Mat back = to_header(v.value());
  EXPECT_EQ(back.data, part.data);
  EXPECT_EQ(back.step[0], 30U);
  EXPECT_EQ(back.type(), CV_8UC3);
  EXPECT_EQ(back.at<cv::Vec3b>(4, 3)[1], 200);
}

TEST(OpencvInterop, what_is_no_image_of_ours_is_refused) {
  const cv::Mat none, deep(4, 4, CV_16UC1), four(4, 4, CV_8UC4);
  const int sizes[3] = {2, 2, 2};
  const cv::Mat cube(3, sizes, CV_8UC1);
  EXPECT_EQ(to_view(none).status(), Status::kInvalidArgument);
  EXPECT_EQ(to_view(cube).status(), Status::kInvalidArgument);
  EXPECT_EQ(to_view(deep).status(), Status::kUnsupported);
  EXPECT_EQ(to_view(four).status(), Status::kUnsupported);
  EXPECT_TRUE(to_header(ImageView{}).empty());
  static_assert(
      !std::is_invocable_v<decltype([](auto&& m) -> decltype(to_view(std::forward<decltype(m)>(m))) {}), cv::Mat>);
}

}  // namespace
}  // namespace accrete::interop
