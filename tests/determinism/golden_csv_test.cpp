// One replay from images to edges.csv, compared line by line with what is kept: every change of the numbers is seen,
// and reviewed as a difference of two texts.
#include <fstream>
#include <sstream>

#include "cli/write/edges_csv.h"
#include "cli/write/snapshot.h"
#include "memory/replay.h"

namespace accrete {
namespace {

constexpr const char* kGolden = ACCRETE_SOURCE_FOLDER "/tests/golden/box.edges.csv";
constexpr int kFrames = 12;

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}
std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> out;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) out.push_back(field);
  return out;
}

// "x: 0.1 instead of 0.2" of every field that differs.
std::string difference(const std::string& header, const std::string& is, const std::string& was) {
  const auto names = fields(header), a = fields(is), b = fields(was);
  if (a.size() != names.size() || b.size() != names.size()) return "  is  " + is + "\n  was " + was + "\n";
  std::string out = "  " + a[0];
  for (std::size_t i = 0; i < names.size(); ++i)
    if (a[i] != b[i])
      out.append("  ").append(names[i]).append(" ").append(a[i]).append(" (was ").append(b[i]).append(")");
  return out + "\n";
}

// The baseline of x86-64 has nothing to fuse: its bits are those of the preset deterministic.
TEST(GoldenCsv, is_what_it_was) {
  const auto accumulator = std::make_unique<Accumulator<test::TightLimits>>(InstructionSet::kBaseline);
  bool configured = false;
  test::replay("box", kFrames, [&](const StereoRig& rig, const StereoFrame& frame, const Motion& motion) {
    if (!configured) configured = accumulator->configure(rig) == Status::kOk;
    ASSERT_EQ(accumulator->step(frame, motion).status, Status::kOk);
  });
  const auto primitives = cli::snapshot(accumulator->model(), {});
  const std::string is = cli::edges_csv(primitives, false, cli::Encoding::kSrgb);
  ASSERT_GT(lines(is).size(), 60U);
  if (std::getenv("ACCRETE_RENEW_GOLDEN") != nullptr) {
    std::ofstream(kGolden, std::ios::binary) << is;
    GTEST_SKIP() << kGolden << " was written: review it with git diff";
  }
  std::ifstream file(kGolden, std::ios::binary);
  std::stringstream was;
  was << file.rdbuf();
  ASSERT_FALSE(was.str().empty()) << kGolden << " cannot be read";
  if (is == was.str()) return;
  const auto a = lines(is), b = lines(was.str());
  std::string text;
  int shown = 0, different = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (a[i] != b[i] && ++different && shown++ < 8) text += difference(a[0], a[i], b[i]);
  FAIL() << different << " of " << a.size() << " lines differ, and there were " << b.size() << ":\n"
         << text << "If the numbers changed on purpose, look at them, and write the file with\n"
         << "  ACCRETE_RENEW_GOLDEN=1 ctest --test-dir BUILD -R GoldenCsv\n"
         << "then say in the commit why. ./dev determinism --renew renews the hashes.";
}

}  // namespace
}  // namespace accrete
