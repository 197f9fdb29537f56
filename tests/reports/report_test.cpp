// The report's page and the exports, from results that no simulation had to make.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include <trocar/reports/export.hpp>
#include <trocar/reports/labels.hpp>
#include <trocar/reports/report_page.hpp>
#include <trocar/reports/report_svg.hpp>
#include <trocar/training/metrics/trace.hpp>

namespace trocar::reports {
namespace {

using training::Attempt;
using training::AttemptMode;
using training::AttemptState;

constexpr const char* kResult = R"({
  "exercise": "gynaecology/sterilisation", "passed": true, "ticks": 200000,
  "simulated_seconds": 200, "exercise_seconds": 190, "exercise_from_s": 5,
  "assessment": {"finished": true,
    "score": {"scored": true, "total": 81.5, "quality": 0.9, "time": 0.8, "motion": null, "penalties": 5.5,
              "points": {"quality": 63.5, "time": 23.5}, "points_at_most": {"quality": 70.6, "time": 29.4},
              "failed_by_error": false, "pass_mark": 80},
    "steps": [{"name": "Survey", "step": "survey", "done": true, "at_s": 12},
              {"name": "Left: Cut", "step": "cut", "side": "left", "done": true, "at_s": 130},
              {"name": "Right: Cut", "step": "cut", "side": "right", "done": false}],
    "elements": {"left": "Left", "right": "Right", "target_6": "disc 6"},
    "details": [{"side": "", "lost_mL": 2.5}, {"side": "target_6", "clipped": [{"on": "tube", "angle_deg": 12.26}]},
                {"side": "right"}],
    "thresholds": {"blind_speed_mm_s": {"value": 5, "source": "ours"}, "blind_s": {"value": 0.2, "source": "ours"},
                   "pinch_impulse_N_s": {"value": 300, "source": "ours"}, "lost_mL": {"value": 10, "source": "ours"},
                   "near_mm": {"from": 40, "to": 60, "source": "ours"}, "seen_share": {"value": 0.8, "source": "ours"}},
    "errors": [{"code": "A1.3", "meaning": "too <near> & deep", "hint": "draw the tip back", "points": 5.5,
                "fail": false, "at_s": 100}]},
  "metrics": {"hands": [{"name": "left_lateral", "path_m": 0.4}, {"name": "right_lateral", "path_m": 0.5}],
              "both": {"name": "all", "path_m": 0.9, "forces": {"pull": {"max_N": 1.5, "limit_N": 4}}},
              "bimanual": {"path_ratio": 0.8}},
  "moments": [{"tick": 100000, "what": "grasped", "text": "grasper grasped tube_left"}]})";

Attempt attempt(std::int64_t number, const std::string& trainee, double score, double path) {
  Attempt a;
  a.number = number;
  a.uuid = "uuid-" + std::to_string(number);
  a.trainee = trainee;
  a.exercise = "gynaecology/sterilisation";
  a.title = "Sterilisation <both sides>";
  a.state = AttemptState::finished;
  a.started = "2026-03-01T10:00:00Z";
  Json result = Json::parse(kResult);
  result["assessment"]["score"]["total"] = score;
  result["metrics"]["both"]["path_m"] = path;
  fill_from_result(result.dump(), a);
  return a;
}

/// Two hands that circle for ten seconds.
training::Trace circles() {
  training::Trace trace;
  trace.instruments = {"grasper"};
  for (const char* name : {"left_lateral", "right_lateral"}) {
    training::TraceHand hand{name, true, {}};
    for (int i = 0; i < 500; ++i) {
      training::TraceSample s;
      s.tip = {0.01 * std::cos(i * 0.02), 0.01 * std::sin(i * 0.02), 0.0001 * i};
      s.pull = {0, 0, i < 250 ? 1.0 : 5.0};
      s.instrument = 0;
      hand.samples.push_back(rounded(s));
    }
    trace.hands.push_back(hand);
  }
  return trace;
}

reports::Report report() {
  Attempt a = attempt(3, "Grace <b>", 81.5, 0.9);
  a.trace = to_bytes(circles());
  reports::Report r = gather(nullptr, a);
  r.history = {attempt(1, "Grace <b>", 40, 2.0), attempt(2, "Grace <b>", 60, 1.5), a};
  return r;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++n;
  return n;
}

TEST(ReportPage, ShowsTheScoreWithEveryComponentAndTheirSum) {
  const std::string page = reports::report_html(report());
  for (const char* text : {"63.5", "23.5", "-5.5", "81.5", "70.6", "29.4", "pass mark 80", "not scored"})
    EXPECT_NE(page.find(text), std::string::npos) << text;
  EXPECT_NE(page.find(">Passed<"), std::string::npos);
}

TEST(ReportPage, SaysWhatWasNotRecorded) {
  reports::Report r = report();
  EXPECT_EQ(reports::report_html(r).find("were not recorded"), std::string::npos);
  r.result["not_recorded"] = {"Some events were not recorded: there were <many>."};
  EXPECT_NE(reports::report_html(r).find("Some events were not recorded: there were &lt;many&gt;."), std::string::npos);
}

TEST(ReportPage, EscapesWhatPeopleWrote) {
  reports::Report r = report();
  r.names = true;
  r.pictures = {{"moment-01.png", "\"><script>alert(1)</script>", 3}};
  const std::string page = reports::report_html(r);
  EXPECT_EQ(page.find("<near>"), std::string::npos);
  EXPECT_NE(page.find("too &lt;near&gt; &amp; deep"), std::string::npos);
  EXPECT_NE(page.find("Grace &lt;b&gt;"), std::string::npos);
  EXPECT_EQ(page.find("alert(1)</script>"), std::string::npos);
  EXPECT_EQ(page.find("Sterilisation <both"), std::string::npos);
}

TEST(ReportPage, NamesNobodyUnlessAsked) {
  reports::Report r = report();
  r.attempt.recording = "/home/grace/data/a.rec";
  const std::string page = reports::report_html(r);
  EXPECT_EQ(page.find("Grace"), std::string::npos);
  EXPECT_EQ(page.find("/home/"), std::string::npos) << "a path is a name, too";
}

TEST(ReportPage, SaysForEachErrorWhatWouldHaveBeenBetter) {
  EXPECT_NE(reports::report_html(report()).find("Better: draw the tip back"), std::string::npos);
}

TEST(ReportPage, NamesLimitsInWordsWithTheirUnits) {
  const std::string page = reports::report_html(report());
  for (const char* text :
       {"Speed of a tip out of view</td><td>5 mm/s<", "Time a tip may move out of view</td><td>0.2 s<",
        "force times time</td><td>300 N s<", "Blood lost</td><td>10 mL<", "Distance from the lens</td><td>40 to 60 mm<",
        "Share seen</td><td>80 %<"})
    EXPECT_NE(page.find(text), std::string::npos) << text;
}

TEST(ReportPage, HasNoEmptyHeadingsAndTitlesInsteadOfNames) {
  const std::string page = reports::report_html(report());
  EXPECT_EQ(page.find("<h3></h3>"), std::string::npos);
  EXPECT_NE(page.find("Blood lost: 2.5 mL"), std::string::npos);
  EXPECT_NE(page.find("<h3>Disc 6</h3>"), std::string::npos);
  EXPECT_NE(page.find("<td>12.3°</td>"), std::string::npos);
  EXPECT_EQ(page.find("<h3>Right</h3>"), std::string::npos) << "nothing was measured of it";
  EXPECT_EQ(page.find("target_6"), std::string::npos);
}

TEST(ReportPage, SaysFirstThatNoExpertsHaveConfirmedTheLimits) {
  const std::string page = reports::report_html(report());
  EXPECT_LT(page.find("No expert group has confirmed"), page.find("<main>"));
}

TEST(ReportPage, LeavesOutRowsThatNothingWasMeasuredFor) {
  reports::Report r = report();
  const std::string with_hands = reports::report_html(r);
  EXPECT_NE(with_hands.find("Instrument path length</th>"), std::string::npos);
  EXPECT_EQ(with_hands.find("Idle time"), std::string::npos) << "no hand has this figure";
  EXPECT_EQ(with_hands.find("Horizon error"), std::string::npos);
  r.trace.reset();
  r.history.clear();
  r.result["metrics"] = {{"hands", Json::array()},
                         {"both", {{"path_m", 0}}},
                         {"camera", {{"path_m", 0.25}, {"horizon_mean_deg", 2.5}, {"on_target_share", 0.4}}}};
  const std::string camera = reports::report_html(r);
  EXPECT_EQ(camera.find("Instrument path length</th>"), std::string::npos);
  EXPECT_NE(camera.find("Endoscope path length</th><td>mm</td><td class=\"n\">250<"), std::string::npos);
  EXPECT_NE(camera.find("Horizon error, mean"), std::string::npos);
  EXPECT_NE(camera.find("Time on target</th><td>%</td><td class=\"n\">40<"), std::string::npos);
}

TEST(Labels, DeriveTheUnitFromTheNamesEnding) {
  EXPECT_EQ(reports::label_of("collision_speed_mm_s").unit, "mm/s");
  EXPECT_EQ(reports::label_of("dry_mL_min").unit, "mL/min");
  EXPECT_EQ(reports::label_of("my_own_limit_mm").title, "My own limit");
  EXPECT_EQ(reports::label_of("my_own_limit_mm").unit, "mm");
  EXPECT_EQ(reports::quantity(12, reports::label_of("clip_angle_deg")), "12°");
  EXPECT_EQ(reports::quantity(0.345, reports::label_of("seen_share")), "34.5 %");
  EXPECT_EQ(reports::plain_number(-52), "-52");
  EXPECT_EQ(reports::plain_number(0.1), "0.1");
  EXPECT_EQ(reports::plain_number(1000), "1000");
}

TEST(Timelines, GiveLongNamesOfLanesRoom) {
  reports::Timeline t;
  t.length = 10;
  t.bars = {{"The uterine tube on the left side", "Cut", 0, 5}};
  const std::string drawing = svg(t);
  EXPECT_NE(drawing.find(">The uterine tube on the left side<"), std::string::npos);
  const std::size_t text = drawing.find(">The uterine tube");
  const std::size_t x = drawing.rfind("x=\"", text);
  EXPECT_GT(std::stod(drawing.substr(x + 3)), 180) << "its end: 33 letters of about 6 px lie left of it";
}

TEST(ReportPage, NeedsNoNetwork) {
  const std::string page = reports::report_html(report());
  EXPECT_EQ(count(page, "http"), count(page, "http://www.w3.org/2000/svg")) << "a namespace's name, nothing fetched";
  EXPECT_EQ(page.find("@import"), std::string::npos);
  EXPECT_EQ(page.find("url("), std::string::npos);
  EXPECT_EQ(page.find(" src=\"/"), std::string::npos);
}

TEST(ReportPage, EveryDrawingIsDescribed) {
  const std::string page = reports::report_html(report());
  EXPECT_GE(count(page, "role=\"img\""), 9u);
  // One is drawn by the script and has a label, all others title and description.
  EXPECT_EQ(count(page, "role=\"img\"") - 1, count(page, "<desc "));
  EXPECT_EQ(count(page, "<title id="), count(page, "<desc "));
}

TEST(ReportPage, DrawsPathsSpeedsForcesAndTheirLimits) {
  const std::string page = reports::report_html(report());
  for (const char* id : {"id=\"turn\"", "id=\"view-front\"", "id=\"view-feet\"", "id=\"view-side\"", "id=\"speed\"",
                         "id=\"force-pull\"", "id=\"timeline\""})
    EXPECT_NE(page.find(id), std::string::npos) << id;
  EXPECT_NE(page.find("limit 4 N"), std::string::npos);
}

TEST(ReportPage, ShowsTheLearningCurveAndTheSpreadOfEarlierAttempts) {
  const std::string page = reports::report_html(report());
  EXPECT_NE(page.find("Before (2)"), std::string::npos);
  EXPECT_NE(page.find("1750 (1500 to 2000)"), std::string::npos) << "path of both [mm]: median and range";
  EXPECT_NE(page.find("From 40 at first to 81.5 now, 3 attempts."), std::string::npos);
  reports::Report first = report();
  first.history.resize(1);
  EXPECT_EQ(reports::report_html(first).find("Learning curve"), std::string::npos);
}

TEST(ReportPage, ComparesWithTheScriptedSurgeon) {
  reports::Report r = report();
  EXPECT_NE(reports::report_html(r).find("--compare demo"), std::string::npos);
  r.scripted = attempt(9, "scripted surgeon", 99, 0.31);
  const std::string page = reports::report_html(r);
  EXPECT_NE(page.find("Demonstration</th>"), std::string::npos);
  EXPECT_NE(page.find(">310<"), std::string::npos) << "its path [mm]";
}

TEST(ReportPage, AnInterruptedAttemptSaysHowFarItCame) {
  Attempt a;
  a.uuid = "x";
  a.exercise = "e";
  a.state = AttemptState::interrupted;
  a.seconds = 83;
  const std::string page = reports::report_html(gather(nullptr, a));
  EXPECT_NE(page.find("Interrupted"), std::string::npos);
  EXPECT_NE(page.find("1:23"), std::string::npos);
}

TEST(ReportPage, StrangeResultsAreNoHarm) {
  for (const char* text :
       {"", "[]", "7", R"({"assessment":7})", R"({"assessment":{"score":[],"steps":7,"errors":[7,null]}})",
        R"({"metrics":{"hands":7,"both":[]},"moments":[7,{"tick":"x"}],"exercise_seconds":"x","notices":7})",
        R"({"metrics":{"hands":[7,{"name":7}]}})", R"({"assessment":{"steps":[{"done":true,"at_s":1e308}]}})",
        R"({"assessment":{"details":[{"side":7,"clips":[{"a":[1]}]}],"thresholds":{"a":7}},"passed":"yes"})"}) {
    Attempt a = attempt(1, "x", 1, 1);
    a.result = text;
    EXPECT_FALSE(reports::report_html(gather(nullptr, a)).empty()) << text;
  }
}

TEST(Plots, KeepExtremesWhenThinned) {
  reports::Series s{"s", {}, {}, 0};
  for (int i = 0; i < 100000; ++i) {
    s.x.push_back(i);
    s.y.push_back(i == 51234 ? 9 : i == 777 ? -9 : 0);
  }
  const reports::Series t = thinned(s, 100);
  EXPECT_LE(t.x.size(), 400u);
  EXPECT_EQ(*std::max_element(t.y.begin(), t.y.end()), 9);
  EXPECT_EQ(*std::min_element(t.y.begin(), t.y.end()), -9);
  EXPECT_TRUE(std::is_sorted(t.x.begin(), t.x.end()));
}

TEST(Plots, AreDrawnOfNothingAndOfConstants) {
  reports::Plot p;
  p.series = {{"s", {}, {}, 0}};
  EXPECT_FALSE(svg(p).empty());
  p.series = {{"s", {1, 2}, {std::nan(""), std::nan("")}, 0}};
  EXPECT_EQ(svg(p).find("nan"), std::string::npos);
  p.series = {{"s", {1, 1}, {0, 0}, 0}};
  EXPECT_EQ(svg(p).find("nan"), std::string::npos);
  EXPECT_EQ(svg(p).find("inf"), std::string::npos);
}

TEST(Export, IsATableThatSpreadsheetsTakeForDataOnly) {
  EXPECT_EQ(reports::csv_field("plain"), "plain");
  EXPECT_EQ(reports::csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(reports::csv_field("say \"no\""), "\"say \"\"no\"\"\"");
  EXPECT_EQ(reports::csv_field("=1+1"), "'=1+1");
  EXPECT_EQ(reports::csv_field("-1.5"), "-1.5");
  const std::string csv =
      reports::attempts_csv({attempt(1, "Ada", 40, 2), attempt(2, "=Bob", 50, 1), attempt(3, "Ada", 60, 1)}, false);
  EXPECT_EQ(count(csv, "\r\n"), 4u);
  EXPECT_EQ(csv.find("Ada"), std::string::npos);
  EXPECT_EQ(count(csv, ",T1,"), 2u);
  EXPECT_EQ(count(csv, ",T2,"), 1u);
  EXPECT_NE(csv.find("both.forces.pull.max_N"), std::string::npos);
  EXPECT_NE(csv.find("hands.left_lateral.path_m"), std::string::npos);
  EXPECT_NE(reports::attempts_csv({attempt(2, "=Bob", 50, 1)}, true).find("'=Bob"), std::string::npos);
  // Every line has as many fields as the first.
  std::istringstream lines(csv);
  std::string line, first;
  std::getline(lines, first);
  while (std::getline(lines, line)) EXPECT_EQ(count(line, ","), count(first, ","));
}

TEST(Export, AsJsonCarriesTheWholeResult) {
  const Json list = reports::attempts_json({attempt(1, "Ada", 40, 2)}, true);
  EXPECT_EQ(list[0]["trainee"], "Ada");
  EXPECT_EQ(list[0]["score"], 40);
  EXPECT_EQ(list[0]["result"]["metrics"]["both"]["path_m"], 2);
}

}  // namespace
}  // namespace trocar::reports
