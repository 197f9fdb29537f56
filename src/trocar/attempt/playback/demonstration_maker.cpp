#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>

#include <trocar/attempt/interrupt.hpp>
#include <trocar/attempt/paths.hpp>
#include <trocar/attempt/playback/demonstration_maker.hpp>
#include <trocar/attempt/playback/kept_demonstration.hpp>
#include <trocar/attempt/session.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/tick.hpp>

namespace trocar::attempt {

namespace fs = std::filesystem;

namespace {

constexpr double kAlmost = 0.99;
constexpr std::uint64_t kTellEvery = 100;  // ticks

/// The recording before it is finished. Removed unless it was given another name.
class Unfinished {
 public:
  explicit Unfinished(fs::path path) : m_path(std::move(path)) {}
  ~Unfinished() {
    std::error_code ignored;
    fs::remove(m_path, ignored);
  }
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;
  const fs::path& path() const { return m_path; }

 private:
  fs::path m_path;
};

training::Attempt told_of(const Lesson& lesson) {
  training::Attempt attempt;
  attempt.uuid = training::new_uuid();
  attempt.trainee = "demonstration";
  attempt.exercise = lesson.name;
  attempt.title = lesson.title;
  attempt.mode = training::AttemptMode::demonstration;
  attempt.seed = lesson.seed;
  attempt.input = "demo";
  return attempt;
}

}  // namespace

double DemonstrationMaker::Progress::share() const {
  if (stage == Stage::done) return 1;
  return expected > 0 ? std::min(kAlmost, seconds / expected) : 0;
}

/// One demonstration, and the thread that records it.
struct DemonstrationMaker::Job {
  Job(const std::string& exercise, std::uint64_t seed) {
    progress.stage = Stage::preparing;
    progress.exercise = progress.title = exercise;
    progress.seed = seed;
    thread = std::thread([this, exercise, seed] { make(exercise, seed); });
  }
  ~Job() {
    stop = true;
    thread.join();
  }
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  void make(const std::string& exercise, std::uint64_t seed);
  void record(const std::string& exercise, std::uint64_t seed);
  bool given_up() const { return stop || interrupted(); }
  /// Changes what is reported, unless it has been cancelled.
  template <class Change>
  void tell(const Change& change) {
    const std::lock_guard guard(lock);
    if (progress.stage != Stage::cancelled) change(progress);
  }

  mutable std::mutex lock;  ///< of the progress
  Progress progress;
  std::atomic<bool> stop{false}, ended{false};
  std::thread thread;
};

DemonstrationMaker::DemonstrationMaker() = default;
DemonstrationMaker::~DemonstrationMaker() = default;

void DemonstrationMaker::start(const std::string& exercise, std::uint64_t seed) {
  cancel();
  std::erase_if(m_jobs, [](const std::unique_ptr<Job>& job) { return job->ended.load(); });
  m_jobs.push_back(std::make_unique<Job>(exercise, seed));
}

void DemonstrationMaker::cancel() {
  if (m_jobs.empty()) return;
  Job& job = *m_jobs.back();
  job.stop = true;
  const std::lock_guard guard(job.lock);
  if (job.progress.stage == Stage::preparing || job.progress.stage == Stage::recording)
    job.progress.stage = Stage::cancelled;
}

void DemonstrationMaker::forget() {
  if (m_jobs.empty() || busy()) return;
  const std::lock_guard guard(m_jobs.back()->lock);
  m_jobs.back()->progress = {};
}

DemonstrationMaker::Progress DemonstrationMaker::progress() const {
  if (m_jobs.empty()) return {};
  const std::lock_guard guard(m_jobs.back()->lock);
  return m_jobs.back()->progress;
}

bool DemonstrationMaker::busy() const {
  const Stage stage = progress().stage;
  return stage == Stage::preparing || stage == Stage::recording;
}

void DemonstrationMaker::Job::make(const std::string& exercise, std::uint64_t seed) {
  try {
    record(exercise, seed);
  } catch (const std::exception& bad) {
    tell([&](Progress& p) {
      p.stage = Stage::failed;
      p.failure = bad.what();
    });
  }
  ended = true;
}

void DemonstrationMaker::Job::record(const std::string& exercise, std::uint64_t seed) {
  const std::unique_ptr<Lesson> lesson = load_lesson(exercise, seed);
  const std::unique_ptr<InputSource> source = lesson->surgeon();
  const fs::path file = demonstration_path(*lesson);
  make_folder(file.parent_path());
  tell([&](Progress& p) {
    p.title = lesson->title;
    p.expected = lesson->exercise->expert_time;
    p.stage = Stage::recording;
  });
  if (given_up()) return;
  const training::Attempt attempt = told_of(*lesson);
  const Unfinished part(fs::path(file.string() + "." + attempt.uuid + ".part"));
  Session session(*lesson);
  session.record(part.path(), attempt);
  sim::Input input = lesson->model.start;
  while (!given_up() && session.broken().empty() && session.recording_failure().empty() &&
         source->next(session.state(), input)) {
    source->after(session.state(), session.advance(input));
    if (session.state().tick % kTellEvery == 0)
      tell([&](Progress& p) { p.seconds = double(session.state().tick) * core::kTick; });
  }
  if (given_up()) return tell([](Progress& p) { p.stage = Stage::cancelled; });
  Json result = session.result(false);
  result["input"] = "demo";
  result.update(source->describe());
  if (const std::string fault = session.finish(result); !fault.empty()) throw core::EnvironmentLacks(fault);
  keep_demonstration(*lesson, part.path());
  tell([&](Progress& p) {
    p.file = file;
    p.passed = result["passed"] == true;
    p.stage = Stage::done;
  });
}

bool reached_pass_mark(const std::string& result_json) {
  const Json result = Json::parse(result_json, nullptr, false);
  return result.is_object() && result.contains("passed") && result["passed"] == true;
}

}  // namespace trocar::attempt
