// YamlFile::load by yaml-cpp. Everything that may throw is inside one try.
#include <yaml-cpp/yaml.h>

#include <exception>

#include "calibration/yaml_file.h"
#include "text/file.h"
#include "text/parse.h"
#include "text/sentence.h"

namespace accrete::hal {
namespace {

constexpr std::size_t kMaxYamlBytes = std::size_t{1} << 20;  // a calibration has 10 kB
constexpr std::size_t kMaxKeys = 1000;

// OpenCV writes "%YAML:1.0", which is no YAML directive.
void drop_opencv_directive(std::string& text) {
  if (!text.starts_with("%YAML:")) return;
  const std::size_t end = text.find('\n');
  for (std::size_t i = 0; i < (end == std::string::npos ? text.size() : end); ++i) text[i] = ' ';
}

// Scalars of sequences that are nested at most twice. False: something else, or too many.
bool flatten(const YAML::Node& node, int depth, std::vector<std::string>& out) {
  if (node.IsScalar()) {
    if (out.size() == YamlFile::kMaxValues) return false;
    out.push_back(node.Scalar());
    return true;
  }
  if (!node.IsSequence() || depth == 0) return false;
  for (const auto& child : node)
    if (!flatten(child, depth - 1, out)) return false;
  return true;
}

int small_integer(const YAML::Node& node) {
  std::int64_t value = 0;
  return node && node.IsScalar() && parse(node.Scalar(), value) && value > 0 && value <= 1000 ? static_cast<int>(value)
                                                                                              : 0;
}

bool fill(const YAML::Node& node, YamlEntry& entry) {
  if (node.IsMap()) {
    const YAML::Node data = node["data"];
    if (!data) {
      entry.map = true;
      return true;
    }
    entry.rows = small_integer(node["rows"]);
    entry.cols = small_integer(node["cols"]);
    return flatten(data, 2, entry.values);
  }
  return node.IsNull() || flatten(node, 2, entry.values);
}

}  // namespace

Outcome YamlFile::load(const std::filesystem::path& path) {
  path_ = path;
  entries_.clear();
  std::string text;
  if (Outcome o = read_text(path, text, kMaxYamlBytes); !o.ok()) return o;
  if (trimmed(text).starts_with("<"))
    return {Status::kUnsupported, path.string() + " is XML: let OpenCV write it as .yml, or convert it"};
  drop_opencv_directive(text);
  try {
    const YAML::Node root = YAML::Load(text);
    if (!root.IsMap())
      return {Status::kDataLoss, path.string() + " is no YAML map of names and values: is this the right file?"};
    for (const auto& item : root) {
      YamlEntry entry;
      if (!item.first.IsScalar()) continue;
      entry.key = item.first.Scalar();
      entry.line = static_cast<std::size_t>(item.first.Mark().line) + 1;
      if (find({entry.key}) != nullptr)
        return {Status::kDataLoss, where(entry) + " occurs a second time: remove one of the two"};
      if (!fill(item.second, entry)) entry.map = true;  // whatever it is, no values of ours
      if (entries_.size() == kMaxKeys)
        return {Status::kCapacityExceeded,
                path.string() + " has more than " + std::to_string(kMaxKeys) + " keys: is this the right file?"};
      entries_.push_back(std::move(entry));
    }
  } catch (const YAML::Exception& e) {
    return {Status::kDataLoss, at_line(path, static_cast<std::size_t>(e.mark.line) + 1) + ": no YAML (" + e.msg +
                                   "): correct it, or copy it again"};
  } catch (const std::exception& e) {
    return {Status::kDataLoss, path.string() + ": no YAML (" + e.what() + "): correct it, or copy it again"};
  }
  return {};
}

}  // namespace accrete::hal
