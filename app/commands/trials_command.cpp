// trocar trials: motions of many attempts from files, their metrics, and what repetition does to them.
#include <algorithm>
#include <fstream>
#include <map>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/log.hpp>
#include <trocar/devices/motion_file.hpp>
#include <trocar/reports/trials_page.hpp>
#include <trocar/training/metrics/study.hpp>

#include "commands/command.hpp"

namespace trocar::app {

namespace fs = std::filesystem;

namespace {

/// Fifty samples a second of the smooth curve through a trial's rows. Only the turn about the shaft is known, not where
/// the shaft points; forces are not known.
training::Trace trace_of(const devices::MotionTrial& trial) {
  const devices::MotionCurve curve(trial);
  training::Trace trace;
  trace.hands = {{"left", false, {}, false}, {"right", false, {}, false}};
  const auto samples = std::size_t(curve.duration() * trace.rate + 1e-6) + 1;
  for (std::size_t i = 0; i < samples; ++i) {
    const devices::MotionSample at = curve.at(trace.time(i));
    for (std::size_t h = 0; h < 2; ++h) {
      const devices::HandMotion& hand = at.hands[h];
      training::TraceSample sample;
      sample.tip = {hand.tip[0], hand.tip[1], hand.tip[2]};
      sample.orientation = quat_from_axis_angle(Vec3d{0, 0, 1}, hand.roll);
      sample.handle = hand.handle;
      trace.hands[h].samples.push_back(sample);
    }
  }
  return trace;
}

/// The file itself, or every CSV file in a folder, by name.
std::vector<fs::path> motion_files(const fs::path& where) {
  std::error_code error;
  if (!fs::is_directory(where, error)) return {where};
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(where, error), end; !error && entry != end; entry.increment(error))
    if (entry->path().extension() == ".csv") files.push_back(entry->path());
  std::sort(files.begin(), files.end());
  if (files.empty())
    throw core::BadInput({{{where.string(), 0, 0}, "expected CSV files of motion in this folder, found none"}});
  return files;
}

/// A person's trials count 1, 2, ... in the order of the files and of their rows.
std::vector<training::StudyAttempt> read_attempts(const std::vector<fs::path>& files) {
  std::vector<training::StudyAttempt> attempts;
  std::map<std::string, int> repetitions;
  double rows = 0, seconds = 0;
  for (const fs::path& file : files)
    for (const devices::MotionTrial& trial : devices::read_motion_file(file)) {
      training::StudyAttempt attempt;
      const std::size_t slash = trial.name.find('/');
      attempt.person = trial.name.substr(0, slash);
      attempt.trial = trial.name.substr(slash + 1);
      attempt.repetition = ++repetitions[attempt.person];
      attempt.metrics = training::metrics_of(trace_of(trial));
      attempts.push_back(std::move(attempt));
      rows += double(trial.samples.size() - 1);
      seconds += trial.samples.back().time;
    }
  core::log::info("{} trials of {} people, {:.0f} s at {:.3g} rows a second", attempts.size(), repetitions.size(),
                  seconds, rows / seconds);
  return attempts;
}

const std::vector<std::string>& remarks() {
  static const std::vector<std::string> all = {
      "Motions from files, joined by smooth curves (docs/guides/motion_input.md) and sampled 50 times a second. What "
      "the rows "
      "do "
      "not hold is not in the figures: with one row a second nothing faster than 0.5 Hz is known, so smoothness and "
      "idle "
      "time describe the joined curve and compare only with files of the same kind.",
      "Angular path is the turn about the shaft only; forces, depth and economy need data that such files lack.",
      "A correlation holds for these people and this task. It says nothing about anybody's skill."};
  return all;
}

void print_summary(const training::Study& study) {
  fmt::print("{} attempts of {} people\n\n{:34} {:>10} {:>23}   {:>28}\n", study.attempts.size(), study.persons.size(),
             "", "median", "quartiles", "rho with repetition (range)");
  for (const training::MetricStudy& m : study.metrics) {
    if (m.all.count == 0) continue;
    const std::string unit = m.column->unit;
    const training::Ranged& rho = m.trend.pooled;
    fmt::print("{:34} {:>10.4g} {:>10.4g} .. {:<10.4g} {:>8.2f} ({:.2f} .. {:.2f})\n",
               m.column->title + (unit.empty() ? "" : " [" + unit + "]"), m.all.median, m.all.lower, m.all.upper,
               rho.value, rho.low, rho.high);
  }
  const training::Trend& t = study.metrics.front().trend;
  fmt::print("\nDuration changes by {:.2f} s with each repetition ({:.2f} .. {:.2f} when a person is left out)\n",
             t.slope.value, t.slope.low, t.slope.high);
}

void write_page(const fs::path& path, const std::string& page) {
  std::ofstream out(path, std::ios::binary);
  out << page;
  if (!out.flush())
    throw core::EnvironmentLacks(
        fmt::format("cannot write {}: does its folder exist, and is there room?", path.string()));
}

int trials(const std::string& where, const std::string& html, bool json) {
  const training::Study study = training::study_of(read_attempts(motion_files(where)));
  Json result = Json::parse(training::study_json(study));
  result["source"] = where;
  result["remarks"] = remarks();
  if (!html.empty()) {
    write_page(html, reports::trials_html(study, "Trials: " + fs::path(where).filename().string(), remarks()));
    result["html"] = html;
  }
  if (json)
    print(result);
  else
    print_summary(study);
  if (!html.empty() && !json) fmt::print("{}\n", html);
  return core::kDone;
}

}  // namespace

void add_trials(CLI::App& program, Chosen& chosen) {
  struct Options {
    std::string where, html;
  };
  auto o = std::make_shared<Options>();
  CLI::App* c = add_command(program, chosen, "trials", "Metrics and learning curve of motions in files",
                            "trocar trials motions.csv --html trials.html");
  c->add_option("motions", o->where, "a CSV file of motions (docs/guides/motion_input.md), or a folder of them")
      ->required();
  c->add_option("--html", o->html, "write a page with drawings to this file");
  c->callback([o, &chosen] { chosen.run = [o, &chosen] { return trials(o->where, o->html, chosen.json); }; });
}

}  // namespace trocar::app
