// `run --save-model` and `run --resume`: two halves make the whole, byte for byte; what is no saved model is refused.
#include <gtest/gtest.h>

#include <cstring>

#include "accumulator/checksum.h"
#include "cli/child.h"
#include "cli/text/file.h"
#include "support/temp_folder.h"

namespace accrete::cli {
namespace {

std::vector<std::string> run(std::vector<std::string> arguments) {
  std::vector<std::string> all = {"run", "synthetic:box-plain", "--scene-frames", "16", "-q"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return all;
}

TEST(resume, two_halves_make_the_whole) {
  const test::TempFolder folder;
  const auto ok = [&](const std::vector<std::string>& arguments) {
    const Ended ended = run_program(folder.path(), run(arguments));
    EXPECT_EQ(ended.status, 0) << ended.err;
  };
  ok({"-o", "whole"});
  ok({"-o", "first", "--frames", "0:8", "--save-model"});
  ok({"-o", "second", "--frames", "9:", "--resume", "first", "--save-model"});
  EXPECT_EQ(read_text_file(folder / "whole/edges.csv"), read_text_file(folder / "second/edges.csv"));
  ok({"-o", "again", "--frames", "0:3", "--resume", "second/model.accrete"});  // times begin anew

  const auto refused = [&](const std::vector<std::string>& arguments, int status, const std::string& piece) {
    const Ended ended = run_program(folder.path(), run(arguments));
    EXPECT_EQ(ended.status, status) << ended.err;
    EXPECT_NE(ended.err.find(piece), std::string::npos) << ended.err;
  };
  refused({"--resume", "whole"}, 4, "whole/model.accrete");
  refused({"--resume", "whole/edges.csv"}, 4, "no saved model");
  refused({"--resume", "first", "--capacity", "large"}, 2, "--capacity default");
  std::string bytes = read_text_file(folder / "first/model.accrete");
  folder.write("cut.accrete", std::string_view(bytes).substr(0, bytes.size() / 2));
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  folder.write("bad.accrete", bytes);
  refused({"--resume", "cut.accrete"}, 4, "cut off");
  refused({"--resume", "bad.accrete"}, 4, "checksum");

  // A number out of a file is no reason to allocate: four thousand million frames, with a checksum that fits.
  bytes = read_text_file(folder / "first/model.accrete");
  constexpr std::size_t kFrames = 76;  // where the model's count of frames is
  ASSERT_EQ(bytes[kFrames], 9);
  bytes.replace(kFrames, 4, "\xf0\xff\xff\xff");
  const std::uint64_t checksum = crc64(std::as_bytes(std::span(bytes).first(bytes.size() - 8)));
  std::memcpy(bytes.data() + bytes.size() - 8, &checksum, 8);
  folder.write("aged.accrete", bytes);
  ok({"-o", "third", "--frames", "9:", "--resume", "aged.accrete"});
  EXPECT_NE(read_text_file(folder / "third/edges.csv").find(",4294967286,"), std::string::npos);
}

}  // namespace
}  // namespace accrete::cli
