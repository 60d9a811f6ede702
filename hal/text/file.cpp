#include "text/file.h"

#include <cstdio>
#include <memory>

#include "text/sentence.h"

namespace accrete::hal {
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

// std::vector<std::uint8_t> or std::string.
template <class Bytes>
Outcome read_whole(const std::filesystem::path& path, std::size_t max_bytes, Bytes& bytes) {
  bytes.clear();
  if (Outcome o = reachable(path); !o.ok()) return o;
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return {Status::kNotFound, path.string() + " is not there: check the name"};
  if (!std::filesystem::is_regular_file(status))  // a pipe would block for ever
    return {Status::kNotFound, path.string() + " is no regular file: give the name of one"};
  const auto size = std::filesystem::file_size(path, error);
  if (error) return {Status::kDataLoss, path.string() + " cannot be read: " + error.message()};
  if (size == 0) return {Status::kDataLoss, path.string() + " is empty (0 bytes): copy it again"};
  if (size > max_bytes)
    return {Status::kCapacityExceeded, path.string() + " has " + std::to_string(size) + " bytes, more than the " +
                                           std::to_string(max_bytes) + " that are read: is this the right file?"};
  const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rb"));
  if (!file) return {Status::kDataLoss, path.string() + " cannot be opened: check its permissions"};
  bytes.resize(static_cast<std::size_t>(size));
  if (std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) {
    bytes.clear();
    return {Status::kDataLoss, path.string() + " cannot be read to its end: check the disk, or copy it again"};
  }
  return {};
}

}  // namespace

Outcome reachable(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::status(path, error).type() != std::filesystem::file_type::none) return {};
  return {Status::kDataLoss, path.string() + " cannot be reached: " + error.message() + "; check the folders above it"};
}

Outcome read_bytes(const std::filesystem::path& path, std::size_t max_bytes, std::vector<std::uint8_t>& bytes) {
  return read_whole(path, max_bytes, bytes);
}

Outcome read_text(const std::filesystem::path& path, std::string& text, std::size_t max_bytes) {
  if (Outcome o = read_whole(path, max_bytes, text); !o.ok()) return o;
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    return {Status::kUnsupported, path.string() + " is UTF-16 text: save it as UTF-8"};
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
  return {};
}

}  // namespace accrete::hal
