#include <algorithm>

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

DemonstrationMaker::~DemonstrationMaker() { cancel(); }

void DemonstrationMaker::start(const std::string& exercise, std::uint64_t seed) {
  cancel();
  m_stop = false;
  {
    const std::lock_guard lock(m_lock);
    m_progress = {};
    m_progress.stage = Stage::preparing;
    m_progress.exercise = m_progress.title = exercise;
    m_progress.seed = seed;
  }
  m_thread = std::thread([this, exercise, seed] { make(exercise, seed); });
}

void DemonstrationMaker::cancel() {
  m_stop = true;
  if (m_thread.joinable()) m_thread.join();
}

void DemonstrationMaker::forget() {
  if (busy()) return;
  const std::lock_guard lock(m_lock);
  m_progress = {};
}

DemonstrationMaker::Progress DemonstrationMaker::progress() const {
  const std::lock_guard lock(m_lock);
  return m_progress;
}

bool DemonstrationMaker::busy() const {
  const Stage stage = progress().stage;
  return stage == Stage::preparing || stage == Stage::recording;
}

void DemonstrationMaker::set(Stage stage) {
  const std::lock_guard lock(m_lock);
  m_progress.stage = stage;
}

void DemonstrationMaker::make(const std::string& exercise, std::uint64_t seed) {
  try {
    record(exercise, seed);
  } catch (const std::exception& bad) {
    const std::lock_guard lock(m_lock);
    m_progress.stage = Stage::failed;
    m_progress.failure = bad.what();
  }
}

void DemonstrationMaker::record(const std::string& exercise, std::uint64_t seed) {
  const std::unique_ptr<Lesson> lesson = load_lesson(exercise, seed);
  const std::unique_ptr<InputSource> source = lesson->surgeon();
  const fs::path file = demonstration_path(*lesson);
  make_folder(file.parent_path());
  {
    const std::lock_guard lock(m_lock);
    m_progress.title = lesson->title;
    m_progress.expected = lesson->exercise->expert_time;
    m_progress.stage = Stage::recording;
  }
  const Unfinished part(fs::path(file.string() + ".part"));
  Session session(*lesson);
  session.record(part.path(), told_of(*lesson));
  sim::Input input = lesson->model.start;
  while (!m_stop && !interrupted() && session.broken().empty() && session.recording_failure().empty() &&
         source->next(session.state(), input)) {
    source->after(session.state(), session.advance(input));
    if (session.state().tick % kTellEvery != 0) continue;
    const std::lock_guard lock(m_lock);
    m_progress.seconds = double(session.state().tick) * core::kTick;
  }
  if (m_stop || interrupted()) return set(Stage::cancelled);
  Json result = session.result(false);
  result["input"] = "demo";
  result.update(source->describe());
  if (const std::string fault = session.finish(result); !fault.empty()) throw core::EnvironmentLacks(fault);
  keep_demonstration(*lesson, part.path());
  const std::lock_guard lock(m_lock);
  m_progress.file = file;
  m_progress.passed = result["passed"] == true;
  m_progress.stage = Stage::done;
}

bool reached_pass_mark(const std::string& result_json) {
  const Json result = Json::parse(result_json, nullptr, false);
  return result.is_object() && result.contains("passed") && result["passed"] == true;
}

}  // namespace trocar::attempt
