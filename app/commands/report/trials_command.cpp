// trocar trials: motions of many attempts from files, their metrics, and what repetition does to them.
#include <algorithm>
#include <fstream>
#include <map>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/log.hpp>
#include <trocar/core/text.hpp>
#include <trocar/devices/motion_file.hpp>
#include <trocar/reports/trials_page.hpp>
#include <trocar/training/metrics/study.hpp>
#include <trocar/training/metrics/trace_csv.hpp>

#include "commands/command.hpp"

namespace trocar::app {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t(256) << 20;  ///< of a file

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
    throw core::BadInput({{{where.string(), 0, 0}, tr("expected CSV files of motion in this folder, found none")}});
  return files;
}

/// The attempts of all files, and what is known of them together.
struct ReadTrials {
  std::vector<training::StudyAttempt> attempts;
  bool own = false, foreign = false;  ///< tables of `trocar report`, and of other programs

  void add(std::string person, std::string trial, const training::Trace& trace) {
    training::StudyAttempt attempt;
    attempt.person = std::move(person);
    attempt.trial = std::move(trial);
    attempt.repetition = ++m_repetitions[attempt.person];
    attempt.metrics = training::metrics_of(trace);
    attempts.push_back(std::move(attempt));
    m_seconds += trace.size() > 1 ? trace.time(trace.size() - 1) - trace.start : 0;
  }
  void say() const {
    core::log::info("{}", tr("trials: {}, people: {}, {:.0f} s", attempts.size(), m_repetitions.size(), m_seconds));
  }

 private:
  std::map<std::string, int> m_repetitions;
  double m_seconds = 0;
};

/// A table that `trocar report --trace` wrote; one without a person counts as a person's of its own.
void read_own(const fs::path& file, const std::string& text, ReadTrials& read) {
  training::TraceOrigin origin;
  const training::Trace trace = training::trace_from_csv(text, file.string(), origin);
  const std::string stem = file.stem().string();
  read.add(origin.person.empty() ? stem : origin.person, origin.trial.empty() ? stem : origin.trial, trace);
  read.own = true;
}

/// A person's trials count 1, 2, ... in the order of the files and of their rows.
ReadTrials read_attempts(const std::vector<fs::path>& files) {
  ReadTrials read;
  for (const fs::path& file : files) {
    if (const std::string text = core::read_file(file, kMostBytes); training::is_trace_csv(text)) {
      read_own(file, text, read);
      continue;
    }
    for (const devices::MotionTrial& trial : devices::read_motion_file(file)) {
      const std::size_t slash = trial.name.find('/');
      read.add(trial.name.substr(0, slash), trial.name.substr(slash + 1), trace_of(trial));
      read.foreign = true;
    }
  }
  read.say();
  return read;
}

std::vector<std::string> remarks_of(const ReadTrials& read) {
  std::vector<std::string> all;
  if (read.foreign) {
    all.push_back(
        tr("Motion from files is joined by smooth curves and sampled 50 times a second. With one row a second nothing "
           "faster than 0.5 Hz is known. Smoothness and idle time then describe the joined curve, and compare only "
           "with files of the same kind."));
    all.push_back(
        tr("The angular path is the turn about the shaft only. Forces, depth and economy need data that such files "
           "lack."));
  }
  if (read.own) all.push_back(tr("Motion of Trocar's own attempts is sampled 50 times a second, with forces."));
  all.push_back(tr("A correlation holds for these people and this task. It does not measure anybody's skill."));
  return all;
}

void print_summary(const training::Study& study) {
  fmt::print("{}\n\n{:34} {:>10} {:>23}   {:>28}\n",
             tr("Attempts: {}, people: {}", study.attempts.size(), study.persons.size()), "", tr("median"),
             tr("quartiles"), tr("rho with repetition (range)"));
  for (const training::MetricStudy& m : study.metrics) {
    if (m.all.count == 0) continue;
    const std::string unit = m.column->unit;
    const training::Ranged& rho = m.trend.pooled;
    fmt::print("{:34} {:>10.4g} {:>10.4g} .. {:<10.4g} {:>8.2f} ({:.2f} .. {:.2f})\n",
               m.column->title + (unit.empty() ? "" : " [" + unit + "]"), m.all.median, m.all.lower, m.all.upper,
               rho.value, rho.low, rho.high);
  }
  const training::Trend& t = study.metrics.front().trend;
  fmt::print("\n{}\n",
             tr("Duration changes by {:.2f} s with each repetition ({:.2f} .. {:.2f} when a person is left out)",
                t.slope.value, t.slope.low, t.slope.high));
}

void write_page(const fs::path& path, const std::string& page) {
  std::ofstream out(path, std::ios::binary);
  out << page;
  if (!out.flush())
    throw core::EnvironmentLacks(
        tr("cannot write {}: check that its folder exists and that the disk has room", path.string()));
}

int trials(const std::string& where, const std::string& html, bool json) {
  ReadTrials read = read_attempts(motion_files(where));
  const std::vector<std::string> remarks = remarks_of(read);
  const training::Study study = training::study_of(std::move(read.attempts));
  Json result = Json::parse(training::study_json(study));
  result["source"] = where;
  result["remarks"] = remarks;
  if (!html.empty()) {
    write_page(html, reports::trials_html(study, "Trials: " + fs::path(where).filename().string(), remarks));
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
  CLI::App* c = add_command(program, chosen, "trials", tr("Compute metrics and learning curve of motion files"),
                            "trocar trials motions --html trials.html");
  c->add_option("motions", o->where,
                tr("a CSV file of motion or a folder of them: tables of `trocar report --trace`, or one row a moment "
                   "with the columns operator, trial, t_ms, xL, yL, zL, rollL, handleL, xR, ... handleR"))
      ->required();
  c->add_option("--html", o->html, tr("write a page with drawings to this file"));
  c->callback([o, &chosen] { chosen.run = [o, &chosen] { return trials(o->where, o->html, chosen.json); }; });
}

}  // namespace trocar::app
