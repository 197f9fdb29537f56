// trocar compare: one organ with both solvers under the same hands, and how far they are apart.
#include <cmath>

#include <fmt/format.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/attempt/press.hpp>
#include <trocar/attempt/solver_comparison.hpp>
#include <trocar/attempt/sources.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/log.hpp>
#include <trocar/core/text.hpp>
#include <trocar/reports/solver_report.hpp>
#include <trocar/sim/recording/recording.hpp>

#include "commands/command.hpp"
#include "commands/number_options.hpp"

namespace trocar::app {
namespace {

constexpr double kUsualShare = 0.05;  // of the organ's size, that is pressed in
constexpr double kTableShares[] = {0.05, 0.10, 0.20};

struct CompareChoice {
  std::string exercise, organ, hands, out = "out/compare";
  double depth_mm = 0, seconds = 0;
  std::uint64_t seed = 0;
  bool table = false, pictures = true;
};

struct Compared {
  attempt::SolverComparison comparison;
  std::string hands;  ///< in words
  Json details;
};

Compared press(const attempt::SolverPair& pair, double depth, double seconds) {
  const sim::Model& model = pair.dynamic->model;
  const attempt::Press plan = attempt::plan_press(model, pair.organ, depth);
  attempt::PressSource source(model, plan);
  const std::string hands = tr("{} at {} presses {:.1f} mm in", model.placed(std::size_t(plan.hand)).name,
                               model.hands[std::size_t(plan.hand)].name, 1e3 * depth);
  if (plan.clear)
    core::log::info("{}", hands);
  else
    core::log::info("{}; no path to it is clear, so other tissue moves too", hands);
  return {attempt::compare_solvers(pair, source, seconds, [&] { return source.settled(); }), hands, source.describe()};
}

Compared replay(const attempt::SolverPair& pair, const CompareChoice& o) {
  const std::unique_ptr<attempt::InputSource> source = attempt::make_source(*pair.dynamic, "replay:" + o.hands);
  return {attempt::compare_solvers(pair, *source, o.seconds), "hands of " + o.hands, {{"recording", o.hands}}};
}

void draw(reports::SolverReport& report, const attempt::SolverPair& pair, const attempt::SolverComparison& comparison,
          const std::filesystem::path& folder) {
  try {
    report.pictures = pictures::draw_solvers(pair, comparison, folder);
  } catch (const core::EnvironmentLacks& lacks) {  // figures are worth having without
    report.pictures_note = lacks.what();
    core::log::warn("no pictures: {}", lacks.what());
  }
}

std::string percent(double share) {
  return std::isfinite(share) ? fmt::format("{:.1f} %", 100 * share) : std::string("-");
}

void print_sample(const std::string& name, const attempt::SolverSample& s) {
  fmt::print("{:28} {:>9.2f} {:>9.3f} {:>8} {:>9.3f} {:>8} {:>9.3f} {:>9.3f} {:>8}\n", name, 1e3 * s.moved, 1e3 * s.rms,
             percent(s.share(s.rms)), 1e3 * s.largest, percent(s.share(s.largest)), s.dynamic_force, s.static_force,
             percent(s.force_share()));
}

void print_comparison(const reports::SolverReport& r) {
  fmt::print("{} of {}: {}\n", r.organ, r.scene, r.hands);
  fmt::print("{:28} {:>9} {:>9} {:>8} {:>9} {:>8} {:>9} {:>9} {:>8}\n", "", "moved mm", "rms mm", "", "largest", "",
             "dynamic N", "static N", "");
  print_sample(r.summary.held.settled ? tr("pressed in, at rest") : tr("at the deepest"), r.summary.held);
  print_sample(tr("farthest apart, {:.2f} s", r.summary.worst.seconds), r.summary.worst);
  for (const reports::SolverPress& p : r.presses)
    print_sample(tr("{:.0f} % of its size, {:.1f} mm", 100 * p.share, 1e3 * p.depth), p.summary.held);
}

Json json_of(const reports::SolverReport& r, const std::string& page) {
  Json presses = Json::array(), files = Json::array();
  for (const reports::SolverPress& p : r.presses)
    presses.push_back(
        {{"share_of_size", p.share}, {"depth_mm", 1e3 * p.depth}, {"held", reports::as_json(p.summary.held)}});
  for (const pictures::SolverPicture& p : r.pictures) files.push_back(p.file);
  return {{"scene", r.scene},
          {"organ", r.organ},
          {"size_mm", 1e3 * r.size},
          {"held", reports::as_json(r.summary.held)},
          {"worst", reports::as_json(r.summary.worst)},
          {"deepest_mm", 1e3 * r.summary.deepest},
          {"rms_mm", 1e3 * r.summary.rms},
          {"samples", r.samples.size()},
          {"presses", presses},
          {"page", page},
          {"pictures", files}};
}

int compare(const CompareChoice& o, bool json) {
  std::uint64_t seed = o.seed;
  if (!o.hands.empty()) seed = sim::read_recording(o.hands).header.seed;  // its anatomy
  attempt::make_folder(o.out);
  const attempt::SolverPair pair = attempt::load_pair(o.exercise, seed, o.organ);
  reports::SolverReport report;
  report.organ = o.organ;
  report.scene = pair.dynamic->name;
  report.size = attempt::organ_size(pair.dynamic->model, pair.organ);
  const double depth = o.depth_mm > 0 ? 1e-3 * o.depth_mm : kUsualShare * report.size;
  const Compared first = o.hands.empty() ? press(pair, depth, o.seconds) : replay(pair, o);
  report.hands = first.hands;
  report.samples = first.comparison.samples();
  report.summary = first.comparison.summary();
  if (o.table)
    for (const double share : kTableShares)
      report.presses.push_back(
          {share * report.size, share, press(pair, share * report.size, o.seconds).comparison.summary()});
  if (o.pictures) draw(report, pair, first.comparison, o.out);
  const std::string page = reports::write_solver_report(o.out, report);
  Json result = json_of(report, page);
  result["hands"] = first.details;
  if (json)
    print(result);
  else
    print_comparison(report), fmt::print("{}\n", page);
  return core::kDone;
}

}  // namespace

void add_compare(CLI::App& program, Chosen& chosen) {
  auto o = std::make_shared<CompareChoice>();
  CLI::App* c = add_command(program, chosen, "compare", tr("Compare both solvers of an organ under the same hands"),
                            "trocar compare gynaecology --organ bladder --table");
  c->add_option("exercise", o->exercise, tr("a scene or an exercise: a name that `trocar list` shows, or a file"))
      ->required();
  c->add_option("--organ", o->organ, tr("the organ that both solvers compute"))->required();
  c->add_option("--hands", o->hands, tr("a recording whose hands are used; default: an instrument presses the organ"));
  c->add_option("--depth", o->depth_mm, tr("depth of the press [mm]; default: 5 % of the organ's size"))
      ->check(number_above(0, 100, "mm"));
  c->add_flag("--table", o->table, tr("also press by 5, 10 and 20 % of the organ's size"));
  c->add_option("--seconds", o->seconds, tr("stop after this simulated time [s]"))
      ->check(number_above(0, kLongestRun, "s"));
  c->add_option("--seed", o->seed, tr("number of a random patient; 0: the standard patient, or the recording's"))
      ->capture_default_str()
      ->transform(whole_number(0, kLargestSeed));
  c->add_option("--out", o->out, tr("folder for figures, pictures and the page"))->capture_default_str();
  c->add_flag_callback(
      "--no-pictures", [o] { o->pictures = false; }, tr("only figures"));
  c->callback([o, &chosen] { chosen.run = [o, &chosen] { return compare(*o, chosen.json); }; });
}

}  // namespace trocar::app
