#include <algorithm>
#include <cctype>

#include "replay/frame_list.h"
#include "text/parse.h"
#include "text/sentence.h"

namespace accrete::hal {
namespace {

namespace fs = std::filesystem;

struct Image {
  std::string stem;
  fs::path path;
};

bool image_extension(const fs::path& path) {
  std::string e = path.extension().string();
  std::transform(e.begin(), e.end(), e.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return e == ".png" || e == ".jpg" || e == ".jpeg" || e == ".pgm" || e == ".ppm" || e == ".pnm";
}

Outcome list(const fs::path& folder, std::vector<Image>& images) {
  images.clear();
  std::error_code error;
  std::size_t others = 0;
  for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
    const fs::path& path = i->path();
    const std::string stem = path.stem().string();
    if (stem.starts_with(".") || !image_extension(path)) {  // "._NAME.png" are no images but macOS's notes
      ++others;
      continue;
    }
    if (images.size() == kMaxFrames)
      return {Status::kCapacityExceeded, folder.string() + " has more than " + std::to_string(kMaxFrames) +
                                             " images: cut the recording into pieces"};
    images.push_back({stem, path});
  }
  if (error) return {Status::kNotFound, folder.string() + " cannot be read: " + error.message()};
  if (images.empty())
    return {Status::kNotFound, folder.string() + " holds no image (PNG, JPEG, PGM, PPM; " +
                                   count(others, "other file") + "): is the recording complete?"};
  std::sort(images.begin(), images.end(), [](const Image& a, const Image& b) {
    return a.stem == b.stem ? a.path < b.path : natural_less(a.stem, b.stem);
  });
  for (std::size_t i = 1; i < images.size(); ++i)
    if (images[i].stem == images[i - 1].stem)
      return {Status::kInvalidArgument, images[i - 1].path.string() + " and " + images[i].path.filename().string() +
                                            " have one name: keep one of them"};
  return {};
}

std::int64_t number_of(const std::string& stem) {
  std::int64_t number = 0;
  const bool digits = stem.find_first_not_of("0123456789") == std::string::npos;
  return digits && parse(stem, number) ? number : -1;
}

}  // namespace

Outcome list_folders(const Layout& layout, FrameList& result) {
  result = {};
  std::vector<Image> left, right;
  if (Outcome o = list(layout.left, left); !o.ok()) return o;
  if (Outcome o = list(layout.right, right); !o.ok()) return o;
  std::size_t i = 0, j = 0;
  for (; i < left.size() || j < right.size(); ++result.union_count) {
    if (j == right.size() || (i < left.size() && natural_less(left[i].stem, right[j].stem))) {
      ++i;
      ++result.left_only;
    } else if (i == left.size() || natural_less(right[j].stem, left[i].stem)) {
      ++j;
      ++result.right_only;
    } else {
      FrameFiles frame;
      frame.left = left[i].path;
      frame.right = right[j].path;
      frame.union_index = result.union_count;
      frame.left_index = i;
      frame.number = number_of(left[i].stem);
      result.frames.push_back(std::move(frame));
      ++i, ++j;
    }
  }
  result.left_count = left.size();
  if (result.frames.empty())
    return {Status::kNotFound, layout.left.string() + " and " + layout.right.string() + " have no name in common (" +
                                   left[0].path.filename().string() + ", " + right[0].path.filename().string() +
                                   " ...): give the two images of a pair the same name"};
  return {};
}

}  // namespace accrete::hal
