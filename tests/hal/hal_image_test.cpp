#include <gtest/gtest.h>

#include <array>
#include <span>
#include <string>

#include "image/image_file.h"
#include "outcome_matchers.h"
#include "support/temp_folder.h"

#if ACCRETE_HAS_PNG
#include <png.h>
#endif
#if ACCRETE_HAS_JPEG
#include <turbojpeg.h>
#endif

namespace accrete::hal {
namespace {

using test::TempFolder;
using Bytes = std::vector<std::uint8_t>;

Outcome read(const std::filesystem::path& path, ImageHeader& header, ImageBuffer& image) {
  ImageReader reader;
  if (Outcome o = reader.open(path, header); !o.ok()) return o;
  return reader.decode(image);
}

TEST(Pnm, GreyAndColourWithComments) {
  const TempFolder folder;
  ImageHeader header;
  ImageBuffer image;
  ASSERT_TRUE(
      succeeds(read(folder.write("a.pgm", "P5 # made by hand\n# twice\n2\r\n2 # size\n255\nabcd"), header, image)));
  EXPECT_EQ(header.width_px, 2);
  EXPECT_EQ(header.bits, 8);
  EXPECT_EQ(header.channels, 1);
  EXPECT_EQ(image.bytes, (Bytes{'a', 'b', 'c', 'd'}));
  EXPECT_EQ(image.format, PixelFormat::kGrey8);
  EXPECT_TRUE(image.view().valid());
  ASSERT_TRUE(succeeds(read(folder.write("a.ppm", "P6\n1 2\n255\nabcdef"), header, image)));
  EXPECT_EQ(header.channels, 3);
  EXPECT_EQ(image.format, PixelFormat::kRgb8);
  EXPECT_EQ(image.bytes, (Bytes{'a', 'b', 'c', 'd', 'e', 'f'}));
}

TEST(Pnm, OtherMaximaAndSixteenBits) {
  const TempFolder folder;
  ImageHeader header;
  ImageBuffer image;
  ASSERT_TRUE(succeeds(read(folder.write("a.pgm", std::string("P5 3 1 15\n\x00\x0f\x08", 13)), header, image)));
  EXPECT_EQ(image.bytes, (Bytes{0, 255, 136}));
  ASSERT_TRUE(
      succeeds(read(folder.write("b.pgm", std::string("P5 3 1 65535\n\x00\x00\xff\xff\x80\x00", 19)), header, image)));
  EXPECT_EQ(header.bits, 16);
  EXPECT_EQ(image.bytes, (Bytes{0, 255, 128}));  // 0x8000 / 257 = 127.5
}

TEST(Pnm, DamagedFilesSaySo) {
  const TempFolder folder;
  ImageHeader header;
  ImageBuffer image;
  const auto data_loss = [&](const char* name, const std::string& content, std::string_view piece) {
    return fails(read(folder.write(name, content), header, image), Status::kDataLoss, {name, piece, "copy it again"});
  };
  EXPECT_TRUE(data_loss("short.pgm", "P5 4 4 255\nabc", "3 of 16 bytes"));
  EXPECT_TRUE(data_loss("head.pgm", "P5 4", "width and height"));
  EXPECT_TRUE(data_loss("zero.pgm", "P5 0 4 255\n", "width and height"));
  EXPECT_TRUE(data_loss("max.pgm", "P5 1 1 70000\na", "1 .. 65535"));
  EXPECT_TRUE(data_loss("blank.pgm", "P5 1 1 255", "no blank"));
  EXPECT_TRUE(fails(read(folder.write("big.pgm", "P5 99999 99999 255\na"), header, image), Status::kCapacityExceeded,
                    {"big.pgm", "99999x99999", "8192x8192"}));
}

TEST(Images, WhatIsNoneIsNamed) {
  const TempFolder folder;
  ImageHeader header;
  ImageBuffer image;
  EXPECT_TRUE(fails(read(folder.write("a.png", "<html>not found"), header, image), Status::kUnsupported,
                    {"a.png", "is no PNG", "convert"}));
  EXPECT_TRUE(fails(read(folder / "none.png", header, image), Status::kNotFound, {"none.png"}));
  EXPECT_TRUE(fails(read(folder.write("e.png", ""), header, image), Status::kDataLoss, {"e.png", "empty"}));
  ImageReader reader;
  EXPECT_TRUE(fails(reader.decode(image), Status::kUnavailable, {"open()"}));
}

#if ACCRETE_HAS_PNG

struct PngSpec {
  int colour = PNG_COLOR_TYPE_GRAY, bits = 8, width = 2, height = 2;
  bool interlaced = false;
};

std::string make_png(const PngSpec& spec, std::span<const std::uint8_t> content) {
  std::string out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &out,
      [](png_structp p, png_bytep data, std::size_t n) {
        static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<const char*>(data), n);
      },
      nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(spec.width), static_cast<png_uint_32>(spec.height), spec.bits,
               spec.colour, spec.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  const png_color palette[] = {{10, 20, 30}, {40, 50, 60}};
  if (spec.colour == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, palette, 2);
  png_write_info(png, info);
  const std::size_t row_bytes = png_get_rowbytes(png, info);
  std::vector<png_bytep> rows;
  Bytes pixels(content.begin(), content.end());
  for (int y = 0; y < spec.height; ++y) rows.push_back(pixels.data() + static_cast<std::size_t>(y) * row_bytes);
  png_write_image(png, rows.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return out;
}

struct PngCase {
  const char* name;
  PngSpec spec;
  std::array<std::uint8_t, 9> pixels;
  int channels;
  std::array<std::uint8_t, 9> expected;
};
void PrintTo(const PngCase& c, std::ostream* os) { *os << c.name; }

class Png : public testing::TestWithParam<PngCase> {};

TEST_P(Png, Decodes) {
  const TempFolder folder;
  ImageHeader header;
  ImageBuffer image;
  const PngCase& c = GetParam();
  ASSERT_TRUE(succeeds(read(folder.write("a.png", make_png(c.spec, c.pixels)), header, image)));
  EXPECT_EQ(header.channels, c.channels);
  EXPECT_EQ(header.bits, c.spec.bits);
  EXPECT_EQ(image.width_px, c.spec.width);
  const int n = c.spec.width * c.spec.height * channels(image.format);
  EXPECT_EQ(image.bytes, Bytes(c.expected.begin(), c.expected.begin() + n));
}

const PngCase kPngCases[] = {
    {"grey8", {PNG_COLOR_TYPE_GRAY, 8, 2, 2, false}, {1, 2, 3, 4}, 1, {1, 2, 3, 4}},
    // v / 257, rounded: no gamma, no linear light.
    {"grey16", {PNG_COLOR_TYPE_GRAY, 16, 2, 2, false}, {0, 0, 255, 255, 128, 0, 1, 1}, 1, {0, 255, 128, 1}},
    {"grey1", {PNG_COLOR_TYPE_GRAY, 1, 2, 2, false}, {0x80, 0x40}, 1, {255, 0, 0, 255}},
    {"grey_alpha", {PNG_COLOR_TYPE_GRAY_ALPHA, 8, 2, 1, false}, {7, 0, 9, 255}, 2, {7, 9}},
    {"rgb8", {PNG_COLOR_TYPE_RGB, 8, 1, 2, false}, {1, 2, 3, 4, 5, 6}, 3, {1, 2, 3, 4, 5, 6}},
    {"rgb16", {PNG_COLOR_TYPE_RGB, 16, 1, 1, false}, {1, 1, 2, 2, 3, 3}, 3, {1, 2, 3}},
    {"rgba", {PNG_COLOR_TYPE_RGB_ALPHA, 8, 1, 2, false}, {1, 2, 3, 0, 4, 5, 6, 9}, 4, {1, 2, 3, 4, 5, 6}},
    {"palette", {PNG_COLOR_TYPE_PALETTE, 8, 2, 1, false}, {1, 0}, 3, {40, 50, 60, 10, 20, 30}},
    {"interlaced", {PNG_COLOR_TYPE_GRAY, 8, 3, 3, true}, {1, 2, 3, 4, 5, 6, 7, 8, 9}, 1, {1, 2, 3, 4, 5, 6, 7, 8, 9}},
};

INSTANTIATE_TEST_SUITE_P(Kinds, Png, testing::ValuesIn(kPngCases),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST(PngFile, TruncatedAtEveryByteFailsWithASentence) {
  const TempFolder folder;
  const std::string whole = make_png({PNG_COLOR_TYPE_RGB, 8, 16, 16, false}, Bytes(16 * 16 * 3, 77));
  ImageHeader header;
  ImageBuffer image;
  for (std::size_t n = 4; n < whole.size(); ++n)
    EXPECT_TRUE(fails(read(folder.write("t.png", whole.substr(0, n)), header, image), Status::kDataLoss,
                      {"t.png", "damaged PNG", "copy it again"}))
        << n;
}

TEST(PngFile, AFlippedBitIsNoticed) {
  const TempFolder folder;
  std::string file = make_png({PNG_COLOR_TYPE_GRAY, 8, 16, 16, false}, Bytes(256, 77));
  file[file.find("IDAT") + 10] ^= 1;
  ImageHeader header;
  ImageBuffer image;
  EXPECT_TRUE(fails(read(folder.write("f.png", file), header, image), Status::kDataLoss, {"f.png", "damaged PNG"}));
}

std::uint32_t crc32_of(std::string_view bytes) {
  std::uint32_t crc = 0xffffffff;
  for (const char c : bytes) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int i = 0; i < 8; ++i) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc;
}

std::string big_endian(std::uint32_t v) {
  return {static_cast<char>(v >> 24), static_cast<char>(v >> 16), static_cast<char>(v >> 8), static_cast<char>(v)};
}

TEST(PngFile, AHugeSizeIsRefusedBeforeItIsAllocated) {
  const TempFolder folder;
  std::string file = make_png({PNG_COLOR_TYPE_GRAY, 8, 2, 2, false}, Bytes{1, 2, 3, 4});
  file.replace(16, 8, big_endian(100000) + big_endian(100000));
  file.replace(29, 4, big_endian(crc32_of(std::string_view(file).substr(12, 17))));
  ImageHeader header;
  ImageBuffer image;
  EXPECT_TRUE(fails(read(folder.write("h.png", file), header, image), Status::kCapacityExceeded,
                    {"h.png", "100000x100000", "scale it down"}));
  EXPECT_TRUE(image.bytes.empty());
}

#endif

#if ACCRETE_HAS_JPEG

std::string make_jpeg(int width, int height, bool grey, int flags = 0) {
  Bytes pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * (grey ? 1 : 3));
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint8_t>(grey ? 90 : (i % 3) * 100);
  tjhandle tj = tjInitCompress();
  unsigned char* out = nullptr;
  unsigned long n = 0;
  tjCompress2(tj, pixels.data(), width, 0, height, grey ? TJPF_GRAY : TJPF_RGB, &out, &n,
              grey ? TJSAMP_GRAY : TJSAMP_420, 90, flags);
  std::string file(reinterpret_cast<const char*>(out), n);
  tjFree(out);
  tjDestroy(tj);
  return file;
}

TEST(Jpeg, GreyColourAndProgressive) {
  const TempFolder folder;
  ImageHeader header;
  ImageBuffer image;
  ASSERT_TRUE(succeeds(read(folder.write("g.jpg", make_jpeg(20, 10, true)), header, image)));
  EXPECT_EQ(header.channels, 1);
  EXPECT_EQ(image.width_px, 20);
  EXPECT_EQ(image.height_px, 10);
  EXPECT_EQ(image.format, PixelFormat::kGrey8);
  EXPECT_NEAR(image.bytes[57], 90, 1);
  for (const int flags : {0, TJFLAG_PROGRESSIVE}) {
    ASSERT_TRUE(succeeds(read(folder.write("c.jpg", make_jpeg(20, 10, false, flags)), header, image)));
    EXPECT_EQ(image.format, PixelFormat::kRgb8);
    EXPECT_NEAR(image.bytes[0], 0, 3);
    EXPECT_NEAR(image.bytes[1], 100, 3);
    EXPECT_NEAR(image.bytes[2], 200, 3);
  }
}

TEST(Jpeg, TruncatedFailsWithASentence) {
  const TempFolder folder;
  const std::string whole = make_jpeg(64, 64, false);
  ImageHeader header;
  ImageBuffer image;
  for (const std::size_t n : {std::size_t{3}, std::size_t{20}, whole.size() / 2, whole.size() - 2})
    EXPECT_TRUE(fails(read(folder.write("t.jpg", whole.substr(0, n)), header, image), Status::kDataLoss,
                      {"t.jpg", "damaged JPEG", "copy it again"}))
        << n;
}

using Decoder = bool (*)(FileBytes, const ImageHeader&, std::uint8_t*, std::string&);

// The pixels, empty where it is refused.
Bytes decoded(const std::string& file, Decoder decode) {
  const FileBytes bytes(reinterpret_cast<const std::uint8_t*>(file.data()), file.size());
  ImageHeader header;
  std::string reason;
  if (!read_jpeg_header(bytes, header, reason)) return {};
  Bytes pixels(static_cast<std::size_t>(header.width_px) * static_cast<std::size_t>(header.height_px) * 3);
  return decode(bytes, header, pixels.data(), reason) ? pixels : Bytes{};
}

TEST(Jpeg, CamerasMayAddBytesBeforeTheEndAndNothingElse) {
  const std::string whole = make_jpeg(64, 48, false), end = whole.substr(whole.size() - 2);
  const std::string body = whole.substr(0, whole.size() - 2);
  const Bytes pixels = decoded(whole, decode_jpeg);
  ASSERT_FALSE(pixels.empty());
  EXPECT_EQ(decoded(whole, decode_camera_jpeg), pixels);
  const std::string padded = body + std::string(20, '\0') + end;
  EXPECT_TRUE(decoded(padded, decode_jpeg).empty());
  EXPECT_EQ(decoded(padded, decode_camera_jpeg), pixels);
  for (const std::size_t n : {body.size(), body.size() - 40, body.size() / 2}) {
    EXPECT_TRUE(decoded(body.substr(0, n), decode_camera_jpeg).empty()) << n;
    if (n < body.size()) {
      EXPECT_TRUE(decoded(body.substr(0, n) + end, decode_camera_jpeg).empty()) << n;
    }
  }
}

// A damaged file says nothing about the next one.
TEST(Jpeg, AGoodFileFollowsABadOne) {
  const std::string whole = make_jpeg(64, 48, false);
  const Bytes pixels = decoded(whole, decode_jpeg);
  for (std::size_t n = 0; n < whole.size(); n += 7) {
    EXPECT_TRUE(decoded(whole.substr(0, n), decode_jpeg).empty());
    ASSERT_EQ(decoded(whole, decode_jpeg), pixels) << n;
    EXPECT_TRUE(decoded(whole.substr(0, n), decode_camera_jpeg).empty());
    ASSERT_EQ(decoded(whole, decode_camera_jpeg), pixels) << n;
  }
}

// Motion JPEG leaves out the tables that every decoder knows.
TEST(Jpeg, CamerasMayLeaveOutTheHuffmanTables) {
  const std::string whole = make_jpeg(64, 48, false);
  std::string bare = whole;
  for (std::size_t at = 0; (at = bare.find("\xFF\xC4", at)) != std::string::npos;) {
    const auto high = static_cast<unsigned char>(bare[at + 2]), low = static_cast<unsigned char>(bare[at + 3]);
    bare.erase(at, 2 + 256U * high + low);
  }
  ASSERT_LT(bare.size() + 400, whole.size());
  EXPECT_EQ(decoded(bare, decode_camera_jpeg), decoded(whole, decode_jpeg));
}

#endif

TEST(Images, ABuildWithoutAFormatSaysSo) {
  if (supported(ImageFormat::kPng) && supported(ImageFormat::kJpeg)) GTEST_SKIP() << "this build has all formats";
  const TempFolder folder;
  ImageHeader header;
  ImageBuffer image;
  if (!supported(ImageFormat::kPng)) {
    EXPECT_TRUE(fails(read(folder.write("a.png", "\x89PNG\r\n"), header, image), Status::kUnsupported,
                      {"a.png", "ACCRETE_WITH_PNG=ON", "PGM"}));
  }
  if (!supported(ImageFormat::kJpeg)) {
    EXPECT_TRUE(fails(read(folder.write("a.jpg", "\xff\xd8\xff\xe0"), header, image), Status::kUnsupported,
                      {"a.jpg", "ACCRETE_WITH_JPEG=ON", "PGM"}));
  }
}

TEST(Images, ABufferIsUsedAgain) {
  const TempFolder folder;
  const auto file = folder.write("a.pgm", "P5 4 1 255\nabcd");
  ImageReader reader;
  ImageHeader header;
  ImageBuffer image;
  ASSERT_TRUE(succeeds(reader.open(file, header)));
  ASSERT_TRUE(succeeds(reader.decode(image)));
  const std::uint8_t* before = image.bytes.data();
  ASSERT_TRUE(succeeds(reader.open(file, header)));
  ASSERT_TRUE(succeeds(reader.decode(image)));
  EXPECT_EQ(image.bytes.data(), before);
}

}  // namespace
}  // namespace accrete::hal
