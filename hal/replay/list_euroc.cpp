#include <algorithm>

#include "replay/frame_list.h"
#include "text/file.h"
#include "text/parse.h"
#include "text/sentence.h"

namespace accrete::hal {
namespace {

namespace fs = std::filesystem;

struct Image {
  Timestamp t;
  std::string name;
  std::size_t line = 0;
};

// A name from outside stays inside its folder.
bool plain_name(std::string_view name) {
  return !name.empty() && name != "." && name != ".." && name.find_first_of("/\\") == std::string_view::npos &&
         name.find('\0') == std::string_view::npos;
}

Outcome read_row(const fs::path& csv, const Row& row, Image& image) {
  image.line = row.line;
  if (!parse(row.fields[0], image.t.ns) || !is_stamp(image.t.ns))
    return {Status::kDataLoss, at_line(csv, row.line) + ": " + in_quotes(row.fields[0]) +
                                   " is no time in integer nanoseconds: the rows are 'time,file name'"};
  // Some exports leave the name out: then it is the time.
  image.name = row.field_count >= 2 && row.field_count <= Row::kMaxFields && !row.fields[1].empty()
                   ? std::string(row.fields[1])
                   : std::to_string(image.t.ns) + ".png";
  if (!plain_name(image.name))
    return {Status::kDataLoss, at_line(csv, row.line) + ": the file name " + in_quotes(image.name) +
                                   " leaves the folder data/: only plain names are read"};
  return {};
}

// What a recording that was killed, or ran into a full disk or a power failure, leaves behind its last whole row: half
// a row, or zeros where rows never reached the disk.
void drop_torn_end(const fs::path& camera, std::string& text, std::vector<std::string>& warnings) {
  const std::size_t zero = text.find('\0');
  const std::size_t end = text.rfind('\n', zero);
  const std::size_t begin = end == std::string::npos ? 0 : end + 1;
  if (begin == text.size()) return;
  RowReader rows(std::string_view(text).substr(begin));
  Row row;
  Image image;
  std::error_code error;
  const fs::path csv = camera / "data.csv";
  // Others leave out the end of the last line, which is whole all the same: its image is there.
  if (zero == std::string::npos &&
      (!rows.next(row) || (read_row(csv, row, image).ok() && fs::exists(camera / "data" / image.name, error))))
    return;
  text.resize(begin);
  warnings.push_back(csv.string() + ": the last row is torn and left out; the recording ended there");
}

Outcome list(const fs::path& camera, std::vector<Image>& images, std::vector<std::string>& warnings) {
  const fs::path csv = camera / "data.csv";
  std::string text;
  if (Outcome o = read_text(csv, text); !o.ok()) return o;
  drop_torn_end(camera, text, warnings);
  images.clear();
  RowReader rows(text);
  bool first = true;
  for (Row row; rows.next(row); first = false) {
    std::int64_t stamp = 0;
    if (first && !parse(row.fields[0], stamp) && row.fields[0].find_first_of("0123456789") == std::string_view::npos)
      continue;  // a header without '#'
    if (images.size() == kMaxFrames)
      return {Status::kCapacityExceeded,
              csv.string() + " has more than " + std::to_string(kMaxFrames) + " rows: cut the recording into pieces"};
    Image image;
    if (Outcome o = read_row(csv, row, image); !o.ok()) return o;
    images.push_back(std::move(image));
  }
  if (images.empty()) return {Status::kNotFound, csv.string() + " lists no image: is the recording complete?"};
  const auto earlier = [](const Image& a, const Image& b) { return a.t < b.t; };
  if (!std::is_sorted(images.begin(), images.end(), earlier)) {
    std::stable_sort(images.begin(), images.end(), earlier);
    warnings.push_back(csv.string() + ": times out of order, sorted");
  }
  for (std::size_t i = 1; i < images.size(); ++i)
    if (images[i].t == images[i - 1].t)
      return {Status::kInvalidArgument, at_line(csv, images[i].line) + ": the same time as line " +
                                            std::to_string(images[i - 1].line) + ": remove one of the two"};
  return {};
}

// Half a period of the left camera, at most 8 ms: more apart, a moving scene has moved.
std::int64_t pairing_tolerance(const std::vector<Image>& left) {
  constexpr std::int64_t kMax_ns = 8'000'000;
  if (left.size() < 2) return kMax_ns;
  std::vector<std::int64_t> periods(left.size() - 1);
  for (std::size_t i = 0; i + 1 < left.size(); ++i) periods[i] = left[i + 1].t - left[i].t;
  const auto middle = periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2);
  std::nth_element(periods.begin(), middle, periods.end());
  return std::min(kMax_ns, *middle / 2);
}

}  // namespace

Outcome list_euroc(const Layout& layout, FrameList& result, std::vector<std::string>& warnings) {
  result = {};
  std::vector<Image> left, right;
  if (Outcome o = list(layout.left, left, warnings); !o.ok()) return o;
  if (Outcome o = list(layout.right, right, warnings); !o.ok()) return o;
  const std::int64_t tolerance = pairing_tolerance(left);
  std::size_t i = 0, j = 0;
  for (; i < left.size() && j < right.size(); ++result.union_count) {
    const std::int64_t skew = right[j].t - left[i].t;
    // A left image waits when the one after it is nearer to the right one, and the other way round.
    const bool next_left_nearer = i + 1 < left.size() && std::abs(right[j].t - left[i + 1].t) < std::abs(skew);
    const bool next_right_nearer = j + 1 < right.size() && std::abs(right[j + 1].t - left[i].t) < std::abs(skew);
    if (std::abs(skew) > tolerance ? skew > 0 : next_left_nearer) {
      ++i;
      ++result.left_only;
    } else if (std::abs(skew) > tolerance || next_right_nearer) {
      ++j;
      ++result.right_only;
    } else {
      FrameFiles frame;
      frame.left = layout.left / "data" / left[i].name;
      frame.right = layout.right / "data" / right[j].name;
      frame.t_left = left[i].t;
      frame.t_right = right[j].t;
      frame.union_index = result.union_count;
      frame.left_index = i;
      result.frames.push_back(std::move(frame));
      ++i, ++j;
    }
  }
  result.left_only += left.size() - i;
  result.right_only += right.size() - j;
  result.union_count += left.size() - i + right.size() - j;
  result.left_count = left.size();
  if (result.frames.empty())
    return {Status::kNotFound, layout.left.string() + " and " + layout.right.string() + " have no two images within " +
                                   number(to_seconds(tolerance) * 1e3) + " ms: are they of one recording?"};
  return {};
}

}  // namespace accrete::hal
