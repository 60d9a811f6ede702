// edges.csv and the PLY files, read back byte by byte; the result folder and its failures.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <bit>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "cli/failure.h"
#include "cli/score/csv_table.h"
#include "cli/score/scored_edges.h"
#include "cli/text/file.h"
#include "cli/write/edges_csv.h"
#include "cli/write/ply.h"
#include "cli/write/result_folder.h"
#include "cli/write/snapshot.h"

namespace accrete::cli {
namespace {

namespace fs = std::filesystem;

// A turned primitive with every field different, so that a mix-up of columns shows.
Primitive3d example(std::uint32_t index) {
  Primitive3d p;
  p.id = {index, 3};
  p.state = index % 3 == 0 ? State::kTentative : index % 3 == 1 ? State::kConfirmed : State::kPreserved;
  p.existence = 0.9F + 0.001F * static_cast<float>(index % 50);
  const float s = std::sqrt(0.5F);
  p.geometry.position = {0.1F, -0.2F + 0.01F * static_cast<float>(index), 0.3F};
  p.geometry.quaternion = {0, 0, s, s};  // local x is +y of the map, local y is -x, local z is +z
  p.tangent = {0, 1, 0};
  for (std::size_t i = 0; i < 21; ++i) p.geometry.covariance[i] = 1e-3F * static_cast<float>(i);
  for (std::size_t i = 0; i < 6; ++i)
    p.geometry.covariance[packed_index(6, i, i)] = 1e-6F * static_cast<float>((i + 1) * (i + 1));
  for (std::size_t i = 0; i < 28; ++i) p.appearance.covariance[i] = 1e-2F * static_cast<float>(i);
  for (std::size_t i = 0; i < 7; ++i)
    p.appearance.covariance[packed_index(7, i, i)] = 0.01F * static_cast<float>((i + 1) * (i + 1));
  p.appearance.mean = {1.25F, {1.0F, 0.5F, 0.0F}, {0.0F, 0.25F, 1.0F}};
  p.observations = 7;
  p.first_frame = 2;
  p.last_frame = 11;
  return p;
}

std::vector<Primitive3d> examples(std::uint32_t n) {
  std::vector<Primitive3d> list;
  for (std::uint32_t i = 1; i <= n; ++i) list.push_back(example(i));
  return list;
}

TEST(edges_csv, has_exactly_the_documented_columns) {
  const std::string head = edges_csv({}, false, Encoding::kLinear);
  EXPECT_EQ(head,
            "id,state,existence,x,y,z,qx,qy,qz,qw,tx,ty,tz,phase,left_r,left_g,left_b,right_r,right_g,right_b,"
            "observations,first_frame,last_frame,sx,sy,sz,srx,sry,srz,sphase,sleft_r,sleft_g,sleft_b,sright_r,sright_g,"
            "sright_b\n");
  const std::string full = edges_csv({}, true, Encoding::kLinear);
  EXPECT_EQ(full.substr(0, head.size() - 1), head.substr(0, head.size() - 1));
  EXPECT_TRUE(full.find(",cg_00,cg_01,cg_02,cg_03,cg_04,cg_05,cg_11,") != std::string::npos);
  EXPECT_TRUE(full.find(",cg_55,ca_00,ca_01,") != std::string::npos);
  EXPECT_TRUE(full.ends_with(",ca_66\n"));
  EXPECT_EQ(std::count(full.begin(), full.end(), ','), 35 + 21 + 28);
}

TEST(edges_csv, reads_back_to_the_same_values) {
  const auto list = examples(5);
  const CsvTable table(edges_csv(list, true, Encoding::kLinear), "edges.csv", {});
  ASSERT_EQ(table.rows(), 5U);
  const Primitive3d& p = list[3];
  const auto at = [&table](const std::string& column) { return static_cast<float>(table.numbers(column)[3]); };
  EXPECT_EQ(table.texts("id")[3], "4-3");
  EXPECT_EQ(table.texts("state")[3], "confirmed");
  EXPECT_EQ(at("existence"), p.existence);
  EXPECT_EQ(at("y"), p.geometry.position[1]);
  EXPECT_EQ(at("qw"), p.geometry.quaternion[3]);
  EXPECT_EQ(at("ty"), 1.0F);
  EXPECT_EQ(at("phase"), 1.25F);
  EXPECT_EQ(at("left_g"), 0.5F);
  EXPECT_EQ(at("right_b"), 1.0F);
  EXPECT_EQ(at("observations"), 7.0F);
  EXPECT_EQ(at("first_frame"), 2.0F);
  EXPECT_EQ(at("last_frame"), 11.0F);
  EXPECT_FLOAT_EQ(at("sx"), 1e-3F);
  EXPECT_FLOAT_EQ(at("srz"), 6e-3F);
  EXPECT_FLOAT_EQ(at("sphase"), 0.1F);
  EXPECT_FLOAT_EQ(at("sright_b"), 0.7F);
  EXPECT_EQ(at("cg_14"), p.geometry.covariance[packed_index(6, 1, 4)]);
  EXPECT_EQ(at("ca_36"), p.appearance.covariance[packed_index(7, 3, 6)]);
}

TEST(linear_light, decodes_srgb_and_carries_the_covariance_along) {
  Primitive3d p = example(1);
  p.appearance.mean.left = {0.0F, 0.02F, 0.5F};
  p.appearance.mean.right = {1.0F, 0.735357F, -0.02F};
  p.appearance.covariance.fill(1e-6F);
  const Primitive3d q = in_linear_light(p, Encoding::kSrgb);
  EXPECT_EQ(q.appearance.mean.left[0], 0.0F);
  EXPECT_NEAR(q.appearance.mean.left[1], 0.02 / 12.92, 1e-7);
  EXPECT_NEAR(q.appearance.mean.left[2], 0.2140411, 1e-6);
  EXPECT_NEAR(q.appearance.mean.right[0], 1, 1e-6);
  EXPECT_NEAR(q.appearance.mean.right[1], 0.5, 1e-5);
  EXPECT_NEAR(q.appearance.mean.right[2], -0.02 / 12.92, 1e-7);
  EXPECT_EQ(q.appearance.mean.phase, p.appearance.mean.phase);
  // The slope, by a difference.
  const auto decoded = [&p](float c) {
    Primitive3d r = p;
    r.appearance.mean.left[2] = c;
    return static_cast<double>(in_linear_light(r, Encoding::kSrgb).appearance.mean.left[2]);
  };
  const double slope = (decoded(0.51F) - decoded(0.49F)) / 0.02;
  EXPECT_NEAR(q.appearance.covariance[packed_index(7, 3, 3)] / 1e-6, slope * slope, 2e-3);
  EXPECT_NEAR(q.appearance.covariance[packed_index(7, 0, 3)] / 1e-6, slope, 2e-3);
  EXPECT_FLOAT_EQ(q.appearance.covariance[packed_index(7, 0, 0)], 1e-6F);

  const Primitive3d same = in_linear_light(p, Encoding::kLinear);
  EXPECT_EQ(same.appearance.mean.left, p.appearance.mean.left);
  Params linear_images;
  linear_images.extract.mixing_width_px = 0;
  EXPECT_EQ(encoding_of(linear_images), Encoding::kLinear);
  EXPECT_EQ(encoding_of({}), Encoding::kSrgb);
}

TEST(edges_csv, is_understood_by_the_scorer) {
  std::vector<std::string> notes;
  const ScoredEdges edges = parse_edges(edges_csv(examples(4), true, Encoding::kSrgb), "edges.csv", notes);
  EXPECT_TRUE(notes.empty());
  EXPECT_TRUE(edges.has_colours && edges.has_covariance && edges.has_phase && edges.has_rotation);
  EXPECT_NEAR(edges.list[0].rotation[3], 1, 1e-6);  // local x = map y
}

TEST(snapshot, accepts_confirmed_and_preserved_above_the_threshold) {
  const auto list = examples(6);
  EXPECT_EQ(accepted(list, 0).size(), 4U);
  EXPECT_EQ(accepted(list, 0.9035F).size(), 2U);
  EXPECT_EQ(accepted(list, 1).size(), 0U);
}

// The parts of a PLY file.
struct Ply {
  std::string header, body;
  explicit Ply(const std::string& file) {
    const std::string end = "end_header\n";
    const auto at = file.find(end) + end.size();
    header = file.substr(0, at);
    body = file.substr(at);
  }
  [[nodiscard]] float number(std::size_t offset) const {
    std::uint32_t v = 0;
    for (std::size_t i = 0; i < 4; ++i)
      v |= static_cast<std::uint32_t>(static_cast<unsigned char>(body[offset + i])) << (8 * i);
    return std::bit_cast<float>(v);
  }
  [[nodiscard]] std::uint32_t index(std::size_t offset) const { return std::bit_cast<std::uint32_t>(number(offset)); }
  [[nodiscard]] int byte(std::size_t offset) const { return static_cast<unsigned char>(body[offset]); }
  [[nodiscard]] bool has(const char* line) const { return header.find(std::string(line) + "\n") != std::string::npos; }
};

TEST(edges_ply, has_the_size_that_its_header_says) {
  const auto list = examples(10);
  const Ply ply(edges_ply(list, MotionMode::kObjectMoves));
  EXPECT_TRUE(ply.header.starts_with("ply\nformat binary_little_endian 1.0\n"));
  EXPECT_TRUE(ply.has("element vertex 10"));
  EXPECT_TRUE(ply.has("comment metres, object frame"));
  const std::size_t stride = 6 * 4 + 3 + 16 * 4;
  ASSERT_EQ(ply.body.size(), 10 * stride);
  EXPECT_EQ(ply.number(2 * stride + 4), list[2].geometry.position[1]);
  EXPECT_EQ(ply.number(2 * stride + 16), 1.0F);  // ny: tangent
  EXPECT_EQ(ply.byte(2 * stride + 24), 128);     // mean of red 1 and 0
  EXPECT_EQ(ply.number(2 * stride + 27), list[2].existence);
}

TEST(lines_ply, joins_pairs_of_vertices_along_the_tangent) {
  const auto list = examples(3);
  const Ply ply(lines_ply(list, MotionMode::kCameraMoves));
  EXPECT_TRUE(ply.has("comment metres, world frame"));
  EXPECT_TRUE(ply.has("element edge 3"));
  ASSERT_EQ(ply.body.size(), 6U * 15 + 3U * 11);
  // Slide sigma along map y is 2 mm: half the pitch is sqrt(3) times that.
  EXPECT_NEAR(ply.number(15 + 4) - ply.number(4), 2 * std::sqrt(3.0F) * 2e-3F, 1e-6);
  EXPECT_EQ(ply.index(90 + 11), 2U);
  EXPECT_EQ(ply.index(90 + 11 + 4), 3U);
}

TEST(ribbons_ply, shows_left_colour_left_and_faces_the_viewer) {
  const Ply ply(ribbons_ply(examples(2), MotionMode::kObjectMoves));
  EXPECT_TRUE(ply.has("element vertex 16"));
  EXPECT_TRUE(ply.has("element face 8"));
  ASSERT_EQ(ply.body.size(), 16U * 15 + 8U * 13);
  const auto vertex = [&ply](std::uint32_t i) {
    return Vec3{ply.number(15 * i), ply.number(15 * i + 4), ply.number(15 * i + 8)};
  };
  for (std::size_t f = 0; f < 8; ++f) {
    const std::size_t at = 16 * 15 + f * 13;
    ASSERT_EQ(ply.byte(at), 3);
    const std::uint32_t a = ply.index(at + 1), b = ply.index(at + 5), c = ply.index(at + 9);
    ASSERT_TRUE(a < 16 && b < 16 && c < 16);
    const Vec3 n = cross(vertex(b) - vertex(a), vertex(c) - vertex(a));
    EXPECT_LT(n[2], 0);                             // local z = map z points away from the viewer
    const bool red = ply.byte(15 * a + 12) == 255;  // the left colour is (1, 0.5, 0), the right one (0, 0.25, 1)
    const double middle_x = (vertex(a)[0] + vertex(b)[0] + vertex(c)[0]) / 3;
    EXPECT_EQ(red, middle_x > 0.1) << f;  // right is local y = -x of the map
  }
}

TEST(ply, an_empty_model_gives_valid_files) {
  EXPECT_EQ(Ply(edges_ply({}, MotionMode::kObjectMoves)).body.size(), 0U);
  EXPECT_TRUE(Ply(lines_ply({}, MotionMode::kObjectMoves)).has("element edge 0"));
  EXPECT_TRUE(Ply(ribbons_ply({}, MotionMode::kObjectMoves)).has("element face 0"));
}

class InTemporaryFolder : public ::testing::Test {
 protected:
  InTemporaryFolder() : before_(fs::current_path()) {
    folder_ = fs::path(::testing::TempDir()) / ("writers_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    fs::current_path(folder_);
  }
  ~InTemporaryFolder() override {
    fs::current_path(before_);
    fs::remove_all(folder_);
  }
  fs::path before_, folder_;
};
using result_folder = InTemporaryFolder;

TEST_F(result_folder, default_name_has_the_time_and_latest_points_to_the_newest) {
  const ResultFolder first({}, "my box");
  EXPECT_TRUE(first.link_latest().empty());
  const ResultFolder second({}, "my box");
  EXPECT_TRUE(second.link_latest().empty());
  EXPECT_NE(first.path(), second.path());
  EXPECT_NE(first.path().filename().string().find("_my_box"), std::string::npos);
  second.write("a/b.txt", "hello");
  EXPECT_EQ(read_text_file("results/latest/a/b.txt"), "hello");
  EXPECT_EQ(fs::read_symlink("results/latest"), second.path().filename());
}

TEST_F(result_folder, leaves_no_temporary_file_behind) {
  const ResultFolder out("here", "x");
  out.write("edges.csv", "1");
  out.write("edges.csv", "2");
  EXPECT_EQ(read_text_file("here/edges.csv"), "2");
  EXPECT_EQ(std::distance(fs::directory_iterator("here"), {}), 1);
  EXPECT_TRUE(out.link_latest().empty());
  EXPECT_FALSE(fs::exists("latest"));
}

TEST_F(result_folder, a_latest_that_is_no_link_is_left_alone) {
  fs::create_directories("results/latest");
  EXPECT_NE(ResultFolder({}, "x").link_latest().find("is no link"), std::string::npos);
}

TEST_F(result_folder, refuses_what_cannot_be_written_with_a_sentence) {
  std::ofstream("file") << "x";
  for (const char* out : {"file", "file/below", "/proc/accrete"}) {
    try {
      const ResultFolder folder(out, "x");
      ADD_FAILURE() << out << " was accepted";
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.status(), ExitStatus::kOutput);
      EXPECT_NE(std::string(failure.what()).find(out), std::string::npos) << failure.what();
      EXPECT_NE(std::string(failure.what()).find("--out"), std::string::npos) << failure.what();
    }
  }
}

TEST_F(result_folder, a_full_disk_keeps_the_old_file_and_says_so) {
  const ResultFolder out("here", "x");
  out.write("edges.csv", "old");
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{4096, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(out.write("edges.csv", std::string(100000, 'x')), Failure);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(read_text_file("here/edges.csv"), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator("here"), {}), 1);
}

}  // namespace
}  // namespace accrete::cli
