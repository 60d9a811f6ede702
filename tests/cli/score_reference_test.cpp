// The scorer against the reference program on random primitives: every number of the two results must agree.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include "cli/score/score.h"
#include "cli/text/file.h"

namespace accrete::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* kPython = "/usr/bin/python3";

fs::path reference() {
  const char* shared = std::getenv("ACCRETE_SHARED");
  return fs::path(shared != nullptr ? shared : ACCRETE_DEFAULT_SHARED) / "score_edges.py";
}

struct Random {
  std::mt19937_64 generator;
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator); }
  double normal(double sigma) { return std::normal_distribution<double>(0, sigma)(generator); }
  Vec3 vector(double sigma) { return {normal(sigma), normal(sigma), normal(sigma)}; }
  Vec3 unit() {
    const Vec3 v = vector(1);
    return (1 / norm(v)) * v;
  }
};

std::string row(const std::vector<double>& values) {
  std::string out;
  for (const double v : values) {
    char text[40];
    std::snprintf(text, sizeof text, "%.9g", v);
    out += (out.empty() ? "" : ",") + std::string(std::isfinite(v) ? text : "");
  }
  return out;
}

std::vector<double> flat(std::initializer_list<Vec3> list) {
  std::vector<double> out;
  for (const Vec3& v : list)
    for (const double x : v) out.push_back(x);
  return out;
}

struct Scene {
  std::vector<Vec3> p, d, n;
  std::vector<double> length;
};

std::string write_truth_csv(Random& random, Scene& scene) {
  std::string text = "x0,y0,z0,x1,y1,z1,nx,ny,nz,left_r,left_g,left_b,right_r,right_g,right_b,visible,kind\n";
  for (int i = 0; i < 25; ++i) {
    scene.p.push_back(random.vector(0.05));
    scene.d.push_back(random.unit());
    scene.length.push_back(random.uniform(0.003, 0.08));
    Vec3 n = cross(scene.d.back(), random.unit());
    scene.n.push_back((1 / norm(n)) * n);
    auto values = flat({scene.p.back(),
                        scene.p.back() + scene.length.back() * scene.d.back(),
                        scene.n.back(),
                        {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)},
                        {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)}});
    if (i % 7 == 3) values[9] = NAN;  // a side without colour
    text += row(values) + (i % 6 == 5 ? ",0" : ",0.5") + (i % 3 == 0 ? ",crease\n" : ",albedo\n");
  }
  return text;
}

// Primitives on the truth with errors of every size, reversed ones, false ones, every state; covariances correlated,
// one in thirty not positive definite.
std::string write_edges_csv(Random& random, const Scene& scene, int count) {
  std::string text = "id,state,existence,x,y,z,qx,qy,qz,qw,tx,ty,tz,phase,left_r,left_g,left_b,right_r,right_g,right_b";
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) text += ",cg_" + std::to_string(i) + std::to_string(j);
  text += "\n";
  for (int k = 0; k < count; ++k) {
    const auto s = static_cast<std::size_t>(random.uniform(0, 24.999));
    Vec3 x = scene.p[s] + random.uniform(-0.004, scene.length[s] + 0.004) * scene.d[s] +
             random.vector(k % 5 == 0 ? 0.01 : 0.0008);
    if (k % 11 == 0) x = random.vector(0.06);
    const double direction = random.uniform(0, 1) < 0.5 ? -1 : 1;
    Vec3 t = direction * scene.d[s] + random.vector(0.05);
    t = (1 / norm(t)) * t;
    Vec3 z = -1.0 * scene.n[s] + random.vector(0.2);
    z = z - dot(z, t) * t;
    z = (1 / norm(z)) * z;
    const Vec3 y = cross(z, t);
    const auto q = to_quaternion({t[0], y[0], z[0], t[1], y[1], z[1], t[2], y[2], z[2]}).value();
    std::array<std::array<double, 6>, 6> a{}, c{};
    for (auto& line : a)
      for (double& v : line) v = random.normal(1);
    const double scale[6] = {6e-4, 6e-4, 6e-4, 0.03, 0.03, 0.03};
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        for (int m = 0; m < 6; ++m) c[i][j] += a[i][m] * a[j][m] * scale[i] * scale[j];
        if (i == j) c[i][j] += (i < 3 ? 1e-9 : 1e-7) - (k % 30 == 7 ? 1e-2 : 0);
      }
    std::vector<double> values = flat({x});
    values.insert(values.end(), {q.x, q.y, q.z, q.w, t[0], t[1], t[2], random.uniform(-4, 4)});
    for (int i = 0; i < 6; ++i) values.push_back(k % 17 == 2 && i == 4 ? NAN : random.uniform(0, 1));
    for (int i = 0; i < 6; ++i)
      for (int j = i; j < 6; ++j) values.push_back(c[i][j]);
    const char* state = k % 4 == 0 ? "tentative" : k % 4 == 1 ? "preserved" : "confirmed";
    text += std::to_string(k) + "-1," + state + "," + row({random.uniform(k % 3 == 0 ? 0 : 0.85, 1)}) + "," +
            row(values) + "\n";
  }
  return text;
}

void compare(const ordered_json& ours, const ordered_json& theirs, const std::string& where, int& numbers) {
  if (theirs.is_object()) {
    for (const auto& [key, value] : theirs.items()) {
      if (key == "notes") continue;  // sentences are our own
      ASSERT_TRUE(ours.contains(key)) << where << "/" << key;
      compare(ours[key], value, where + "/" + key, numbers);
    }
    for (const auto& [key, value] : ours.items())
      EXPECT_TRUE(theirs.contains(key)) << where << "/" << key << " is only ours";
  } else if (theirs.is_array()) {
    ASSERT_EQ(ours.size(), theirs.size()) << where;
    for (std::size_t i = 0; i < theirs.size(); ++i)
      compare(ours[i], theirs[i], where + "/" + std::to_string(i), numbers);
  } else if (theirs.is_number()) {
    ASSERT_TRUE(ours.is_number()) << where;
    const double a = ours.get<double>(), b = theirs.get<double>();
    EXPECT_NEAR(a, b, 1e-6 * std::max(1.0, std::abs(b))) << where;
    ++numbers;
  } else {
    EXPECT_EQ(ours, theirs) << where;
  }
}

class ScoreReference : public ::testing::TestWithParam<int> {};

TEST_P(ScoreReference, agrees_in_every_number) {
  if (!fs::exists(reference())) GTEST_SKIP() << "no " << reference() << "; set ACCRETE_SHARED";
  if (std::system((std::string(kPython) + " -c 'import numpy' 2>/dev/null").c_str()) != 0)
    GTEST_SKIP() << kPython << " with numpy is not there";
  Random random{std::mt19937_64(static_cast<std::uint64_t>(GetParam()))};
  const fs::path folder = fs::path(::testing::TempDir()) / ("score_reference_" + std::to_string(GetParam()));
  fs::create_directories(folder);
  Scene scene;
  const auto put = [&folder](const char* name, const std::string& text) { std::ofstream(folder / name) << text; };
  put("edges.csv", write_truth_csv(random, scene));
  Scene other;
  put("extra.csv", write_truth_csv(random, other));
  put("background.csv", write_truth_csv(random, other));
  put("region.txt", "# box\n-0.1 -0.12 -0.09 0.1 0.11 0.12\n");
  put("bbox.txt", "-0.08 -0.07 -0.1 0.09 0.08 0.07");
  put("faces.csv",
      "x0,y0,z0,x1,y1,z1,x2,y2,z2,x3,y3,z3,name\n-0.1,-0.1,0,0.1,-0.1,0.01,0.1,0.1,0.01,-0.1,0.1,0,a\n"
      "0,-0.1,-0.1,0,0.1,-0.1,0,0.1,0.1,0,-0.1,0.1,b\n");
  const std::string edges_text = write_edges_csv(random, scene, GetParam() == 0 ? 0 : 700);
  std::ofstream(folder / "mine.csv") << edges_text;

  const std::string f = folder.string();
  std::string command = std::string(kPython) + " " + reference().string() + " --edges " + f + "/mine.csv --truth " + f +
                        "/edges.csv --json " + f + "/out.json";
  Truth truth = read_truth(folder);
  if (GetParam() % 2 == 1) {
    command += " --extra " + f + "/extra.csv --region " + f + "/region.txt --bbox " + f + "/bbox.txt --background " +
               f + "/background.csv --faces " + f + "/faces.csv";
  } else {
    truth.extra.reset(), truth.background.reset(), truth.region.reset(), truth.bbox.reset(), truth.faces.clear();
  }
  ScoreSettings settings;
  if (GetParam() == 3) {
    command +=
        " --tol-mm 1.5 --pitch-mm 3 --along-mm 4 --angle-deg 12 --gate-mm 6 --bg-tol-mm 25 --end-mm 1 "
        "--min-existence 0.95 --truth-sigma-mm 0.2 --truth-sigma-deg 0.5";
    settings = {1.5, 3, 4, 12, 6, 25, 1, 0.95, 0.2, 0.5};
  }
  ASSERT_EQ(std::system((command + " > /dev/null").c_str()), 0) << command;
  std::vector<std::string> notes;
  const ScoredEdges edges = parse_edges(edges_text, "mine", notes);
  const ordered_json ours = score(edges, truth, settings, notes);
  const auto theirs = ordered_json::parse(read_text_file(folder / "out.json"));
  int numbers = 0;
  compare(ours, theirs, "", numbers);
  EXPECT_GE(numbers, GetParam() == 0 ? 10 : 100);
  fs::remove_all(folder);
}

// 0: no primitive at all; odd: with every optional file; 3: with every setting changed.
INSTANTIATE_TEST_SUITE_P(random_scenes, ScoreReference, ::testing::Values(0, 1, 2, 3, 5));

}  // namespace
}  // namespace accrete::cli
