// Small cases of the scorer whose every figure is known by hand.
#include "cli/score/score.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cli/failure.h"
#include "cli/score/association.h"
#include "cli/score/statistics.h"

namespace accrete::cli {
namespace {

// One edge of 100 mm along x, dark (0.2) on the right, bright (0.8) on the left for a walker along +x who looks against
// the normal -z: right = t x n = (1,0,0) x (0,0,-1) = (0,1,0).
constexpr const char* kTruth = "x0,y0,z0,x1,y1,z1,left,right,nx,ny,nz,kind\n0,0,0,0.1,0,0,0.8,0.2,0,0,-1,line\n";
constexpr const char* kHead = "id,x,y,z,tx,ty,tz,existence,state,phase,left_r,left_g,left_b,right_r,right_g,right_b\n";

nlohmann::ordered_json score_text(const std::string& edges, const ScoreSettings& settings = {},
                                  const char* truth_text = kTruth) {
  Truth truth;
  truth.edges = parse_segments(truth_text, "truth");
  std::vector<std::string> notes;
  const ScoredEdges parsed = parse_edges(edges, "edges", notes);
  return score(parsed, truth, settings, notes);
}

TEST(score, counts_distances_and_directions_of_three_known_primitives) {
  const std::string edges = std::string(kHead) +
                            "a,0.03,0.001,0,1,0,0,0.99,confirmed,1.5708,0.8,0.8,0.8,0.2,0.2,0.2\n"    // 1 mm off
                            "b,0.05,0,0.002,-1,0,0,0.95,preserved,-1.5708,0.2,0.2,0.2,0.8,0.8,0.8\n"  // 2 mm, reversed
                            "c,0.07,0,0,0,1,0,0.95,confirmed,0,0,0,0,0,0,0\n"     // on it, across it
                            "d,0.07,0.05,0,1,0,0,0.95,confirmed,0,0,0,0,0,0,0\n"  // 50 mm off
                            "e,0.07,0,0,1,0,0,0.5,confirmed,0,0,0,0,0,0,0\n"      // not probable enough
                            "f,0.07,0,0,1,0,0,0.95,tentative,0,0,0,0,0,0,0\n";
  const auto r = score_text(edges);
  EXPECT_EQ(r["counts"]["primitives"], 6);
  EXPECT_EQ(r["counts"]["judged"], 4);
  EXPECT_DOUBLE_EQ(r["precision"], 0.5);
  EXPECT_DOUBLE_EQ(r["outlier_rate"], 0.25);
  EXPECT_DOUBLE_EQ(r["wrong_direction_rate"], 0.25);
  EXPECT_NEAR(r["distance_mm"]["median"], 1.5, 1e-12);
  EXPECT_NEAR(r["distance_mm"]["rms"], std::sqrt(2.5), 1e-12);
  EXPECT_NEAR(r["distance_mm"]["p95"], 1.95, 1e-12);
  EXPECT_DOUBLE_EQ(r["colour"]["side_assignment_correct"], 1);
  EXPECT_NEAR(r["colour"]["rms_left"], 0, 1e-12);
  EXPECT_DOUBLE_EQ(r["phase"]["within_0.5rad_of_step"], 1);
  EXPECT_DOUBLE_EQ(r["phase"]["positive_when_right_brighter"], 0);  // +pi/2 is bright on the left
}

TEST(score, swapped_sides_are_found) {
  const auto r = score_text(std::string(kHead) + "a,0.03,0,0,1,0,0,0.99,confirmed,-1.57,0.2,0.2,0.2,0.8,0.8,0.8\n");
  EXPECT_DOUBLE_EQ(r["colour"]["side_assignment_correct"], 0);
}

TEST(score, completeness_is_the_length_within_reach_of_a_primitive) {
  // One primitive at the middle of 100 mm covers 5 mm to each side: a tenth.
  const auto r = score_text(std::string(kHead) + "a,0.05,0,0,1,0,0,0.99,confirmed,0,0,0,0,0,0,0\n");
  EXPECT_NEAR(r["completeness"], 0.1, 1e-9);
  EXPECT_NEAR(r["completeness_by_kind"]["line"], 0.1, 1e-9);
  EXPECT_NEAR(r["primitives_per_covered_10mm"], 1, 1e-9);
}

TEST(score, an_edge_that_was_never_visible_is_not_missed) {
  const char* truth = "x0,y0,z0,x1,y1,z1,visible\n0,0,0,0.1,0,0,3\n0,1,0,0.1,1,0,0\n";
  const auto r = score_text(std::string(kHead) + "a,0.05,0,0,1,0,0,0.99,confirmed,0,0,0,0,0,0,0\n", {}, truth);
  EXPECT_NEAR(r["truth_length_m"], 0.1, 1e-12);
  EXPECT_NEAR(r["completeness"], 0.1, 1e-9);
}

TEST(score, region_extra_box_background_and_faces_select_what_they_say) {
  Truth truth;
  truth.edges = parse_segments(kTruth, "truth");
  truth.extra = parse_segments("x0,y0,z0,x1,y1,z1\n0,0.004,0,0.1,0.004,0\n", "extra");
  truth.background = parse_segments("x0,y0,z0,x1,y1,z1\n0,0,1,0.1,0,1\n", "background");
  truth.region = parse_box("# a comment\n-1 -1 -1 1 1 0.5\n", "region");
  truth.bbox = parse_box("-1 -1 -1 1 1 0.9", "bbox");
  truth.faces = parse_faces("x0,y0,z0,x1,y1,z1,x2,y2,z2,x3,y3,z3\n0,0,0,0.1,0,0,0.1,0.1,0,0,0.1,0\n", "faces");
  std::vector<std::string> notes;
  const ScoredEdges edges = parse_edges(std::string(kHead) +
                                            "a,0.05,0.0035,0,1,0,0,0.99,confirmed,0,0,0,0,0,0,0\n"  // nearer to extra
                                            "b,0.05,0,1.001,1,0,0,0.99,confirmed,0,0,0,0,0,0,0\n"   // background
                                            "c,0.05,0.0005,0.001,1,0,0,0.99,confirmed,0,0,0,0,0,0,0\n",  // right
                                        "edges", notes);
  const auto r = score(edges, truth, {});
  EXPECT_EQ(r["counts"]["not_judged_extra"], 1);
  EXPECT_EQ(r["counts"]["outside_region"], 1);
  EXPECT_EQ(r["counts"]["judged"], 1);
  EXPECT_EQ(r["leakage"]["outside_bbox"], 1);
  EXPECT_EQ(r["leakage"]["background"], 1);
  EXPECT_NEAR(r["surface"]["within_tol_rate"], 2.0 / 3, 1e-12);
}

TEST(score, nees_of_a_known_error_is_the_sum_of_the_squared_ratios) {
  // Own frame = frame of the file (tangent x, y right, z away). Truth line passes 2 mm above in y (sigma 1 mm): 4; and
  // 3 mm in z (sigma 1 mm): 9; parallel. Roll and slide do not count, however small their variance.
  std::string head = "id,x,y,z,tx,ty,tz,existence,state,qx,qy,qz,qw",
              row = "a,0.05,-0.002,-0.003,1,0,0,0.99,confirmed,0,0,0,1";
  const double diagonal[6] = {1e-12, 1e-6, 1e-6, 1e-12, 0.01, 0.01};
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) {
      head += ",cg_" + std::to_string(i) + std::to_string(j);
      row += "," + std::to_string(0) + (i == j ? "e0" : "");
      if (i == j)
        row.replace(row.rfind("0e0"), 3, [&] {
          char t[32];
          std::snprintf(t, sizeof t, "%.3e", diagonal[i]);
          return std::string(t);
        }());
    }
  ScoreSettings settings;
  settings.tolerance_mm = 5;
  const auto r = score_text(head + "\n" + row + "\n", settings);
  EXPECT_NEAR(r["nees"]["within_tol"]["mean"], 13, 1e-9);
  EXPECT_NEAR(r["nees"]["within_tol"]["mean_position_2dof"], 13, 1e-9);
  EXPECT_NEAR(r["nees"]["within_tol"]["mean_direction_2dof"], 0, 1e-12);
}

TEST(score, existence_calibration_compares_probability_with_truth) {
  const auto r = score_text(std::string(kHead) +
                            "a,0.05,0,0,1,0,0,0.8,confirmed,0,0,0,0,0,0,0\n"
                            "b,0.05,0.5,0,1,0,0,0.8,confirmed,0,0,0,0,0,0,0\n");
  EXPECT_NEAR(r["existence"]["ece"], 0.3, 1e-12);  // says 0.8, half of them are right
}

TEST(score, says_what_is_wrong_with_a_file) {
  const auto message = [](auto&& call) -> std::string {
    try {
      call();
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.status(), ExitStatus::kInput);
      return failure.what();
    }
    return "";
  };
  std::vector<std::string> notes;
  EXPECT_EQ(message([] { (void)parse_segments("", "t"); }), "t: empty; a header line is needed");
  EXPECT_EQ(message([] { (void)parse_segments("x0,y0,z0,x1,y1\n", "t"); }),
            "t: header lacks the column z1 (found: x0, y0, z0, x1, y1)");
  EXPECT_EQ(message([] { (void)parse_segments("x0,y0,z0,x1,y1,z1\n0,0,0,0,0,0\n", "t"); }),
            "t: segment 1 has no length");
  EXPECT_EQ(message([] { (void)parse_segments("x0,y0,z0,x1,y1,z1\n0,0,nan,0,0,1\n", "t"); }),
            "t: segment 1: a coordinate is missing or not finite");
  EXPECT_EQ(message([] { (void)parse_segments("x0,y0,z0,x1,y1,z1\n0,0,0\n", "t"); }),
            "t: data line 2 has 3 fields, the header 6");
  EXPECT_EQ(message([] { (void)parse_box("0 0 0 1 1", "b"); }),
            "b: needs six numbers xmin ymin zmin xmax ymax zmax with max > min");
  EXPECT_EQ(message([] { (void)parse_box("0 0 0 1 -1 1", "b"); }),
            "b: needs six numbers xmin ymin zmin xmax ymax zmax with max > min");
  EXPECT_NE(message([&] {
              (void)parse_edges(std::string(kHead) + "a,0,0,0,1,0,0,1,maybe,0,0,0,0,0,0,0\n", "e", notes);
            }).find("unknown state 'maybe'"),
            std::string::npos);
  EXPECT_NE(message([&] {
              (void)parse_edges(std::string(kHead) + "a,0,0,0,1,0,0,2,confirmed,0,0,0,0,0,0,0\n", "e", notes);
            }).find("existence must lie in 0..1"),
            std::string::npos);
}

TEST(score, drops_what_is_not_finite_and_says_so) {
  const auto r = score_text(std::string(kHead) +
                            "a,nan,0,0,1,0,0,0.99,confirmed,0,0,0,0,0,0,0\n"
                            "b,0.05,0,0,2,0,0,0.99,confirmed,0,0,0,0,0,0,0\n");
  EXPECT_EQ(r["counts"]["primitives"], 1);
  ASSERT_EQ(r["notes"].size(), 2U);
  EXPECT_NE(r["notes"][0].get<std::string>().find("1 of 2 primitives dropped"), std::string::npos);
  EXPECT_NE(r["notes"][1].get<std::string>().find("not unit vectors"), std::string::npos);
}

TEST(score, crlf_byte_order_mark_quotes_and_comments_are_read) {
  const Segments s =
      parse_segments("\xEF\xBB\xBF# c\r\nx0, y0,z0,x1,y1,z1,kind\r\n\r\n0,0,0,+0.1,0,0,\"a, b\"\r\n", "t");
  ASSERT_EQ(s.list.size(), 1U);
  EXPECT_EQ(s.list[0].kind, "a, b");
  EXPECT_DOUBLE_EQ(s.list[0].length_m, 0.1);
}

TEST(statistics, percentiles_interpolate) {
  EXPECT_DOUBLE_EQ(percentile({3, 1, 2, 4}, 50), 2.5);
  EXPECT_DOUBLE_EQ(percentile({7}, 95), 7);
  EXPECT_DOUBLE_EQ(percentile({0, 10}, 95), 9.5);
}

TEST(statistics, chi_square_quantiles_are_those_of_the_tables) {
  EXPECT_NEAR(chi2_quantile(0.95, 4), 9.488, 0.01 * 9.488);
  EXPECT_NEAR(chi2_quantile(0.025, 400), 346.48, 0.5);
}

TEST(association, a_tie_between_collinear_neighbours_goes_to_the_one_that_holds_the_foot) {
  const Segments s = parse_segments("x0,y0,z0,x1,y1,z1\n0,0,0,0.1,0,0\n0.1,0,0,0.2,0,0\n", "t");
  EXPECT_EQ(associate({{0.102, 0.001, 0}, {1, 0, 0}}, s, 0.3, 0.005).segment, 1);
  EXPECT_EQ(associate({{0.098, 0.001, 0}, {1, 0, 0}}, s, 0.3, 0.005).segment, 0);
  EXPECT_EQ(associate({{0.206, 0, 0}, {1, 0, 0}}, s, 0.3, 0.005).segment, -1);
}

}  // namespace
}  // namespace accrete::cli
