#include <algorithm>
#include <chrono>
#include <ctime>

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <trocar/attempt/attempt_log.hpp>
#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/log.hpp>
#include <trocar/core/text.hpp>

namespace trocar::attempt {

namespace fs = std::filesystem;
using training::AttemptMode;
using training::AttemptState;

namespace {

/// A new empty file in `folder`: two programs that start in the same second do not share one. Empty path: impossible.
fs::path new_recording(const fs::path& folder, const training::Attempt& attempt) {
  if (folder.empty()) return {};
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  std::string name = attempt.exercise;
  for (char& c : name)
    if (c == '/' || static_cast<unsigned char>(c) < 0x20) c = '-';
  if (name.size() > 80) name = name.substr(name.size() - 80);
  const std::string stem = fmt::format("{}-{:%Y-%m-%d-%H%M%S}", name, fmt::localtime(std::time(nullptr)));
  for (int n = 1; n < 1000; ++n) {
    const fs::path path = folder / (n == 1 ? stem + ".rec" : fmt::format("{}-{}.rec", stem, n));
    const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (file >= 0) {
      close(file);
      return path;
    }
    if (errno != EEXIST) break;
  }
  return {};
}

std::string demonstrator(const std::string& input) {
  return input == "demo" ? "demonstration" : input.rfind("replay:", 0) == 0 ? "replay" : "";
}

}  // namespace

std::string utc_now() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

AttemptMode mode_of_input(const std::string& input) {
  if (demonstrator(input).empty()) return AttemptMode::assessed;
  constexpr std::string_view kReplay = "replay:";
  if (input.rfind(kReplay, 0) != 0) return AttemptMode::demonstration;
  try {
    const sim::Recording recording = sim::read_recording(input.substr(kReplay.size()));
    if (training::mode_in_header(recording.header.metadata_json) == AttemptMode::familiarisation)
      return AttemptMode::familiarisation;
  } catch (const core::BadInput&) {  // told by who uses it
  } catch (const core::EnvironmentLacks&) {
  }
  return AttemptMode::demonstration;
}

AttemptLog::AttemptLog(training::Store* store, Session& session, const AttemptPlan& plan)
    : m_store(store), m_session(session) {
  const Lesson& lesson = session.lesson();
  m_attempt.uuid = training::new_uuid();
  m_attempt.trainee = training::clean_name(plan.trainee);
  if (m_attempt.trainee.empty()) m_attempt.trainee = demonstrator(plan.input);
  if (m_attempt.trainee.empty()) m_attempt.trainee = "guest";
  m_attempt.exercise = lesson.name;
  m_attempt.title = lesson.title;
  m_attempt.mode = plan.mode == AttemptMode::assessed && !lesson.exercise ? AttemptMode::free_practice : plan.mode;
  m_attempt.seed = lesson.seed;
  m_attempt.input = plan.input;
  m_attempt.started = utc_now();
  m_attempt.program_version = TROCAR_VERSION;
  m_attempt.model_hash = lesson.model.hash;
  m_session.set_scored(plan.mode != AttemptMode::familiarisation);
  if (m_store) m_lock = m_store->begin(m_attempt);
  try {
    place_recording(plan);
  } catch (...) {  // without its recording it does not begin
    if (m_store) m_store->withdraw(m_attempt, m_lock);
    throw;
  }
  if (m_store && !m_attempt.recording.empty()) m_store->update(m_attempt);
  take_notices();
}

AttemptLog::~AttemptLog() {
  if (m_ended) return;
  if (m_session.state().tick == 0) {  // never begun: somebody's fault came first, and nothing is worth keeping
    m_session.finish(Json::object());
    std::error_code ignored;
    if (!m_attempt.recording.empty()) fs::remove(m_attempt.recording, ignored);
    if (m_store) m_store->withdraw(m_attempt, m_lock);
    return;
  }
  Json result = m_session.result(true);
  end(result, AttemptState::aborted);
}

void AttemptLog::place_recording(const AttemptPlan& plan) {
  if (!plan.recording.empty()) {
    if (plan.recording.has_parent_path()) {
      std::error_code ignored;
      fs::create_directories(plan.recording.parent_path(), ignored);
    }
    const fs::path moved = keep_older(plan.recording);
    if (m_store && !moved.empty()) m_store->recording_moved(plan.recording, moved);
    m_session.record(plan.recording, m_attempt);
    m_attempt.recording = fs::absolute(plan.recording).string();
    return;
  }
  if (!plan.record || !m_store) return;
  if (try_to_record(new_recording(m_store->folder() / "recordings", m_attempt))) return;
  if (try_to_record(new_recording(training::own_temporary_folder(), m_attempt)))
    notice(tr("{} cannot be written: the recording goes to {}", (m_store->folder() / "recordings").string(),
              m_attempt.recording));
  else
    notice("the attempt is not recorded: neither the data folder nor the temporary folder is writable");
}

bool AttemptLog::try_to_record(const fs::path& path) {
  if (path.empty()) return false;
  try {
    m_session.record(path, m_attempt);
  } catch (const core::EnvironmentLacks&) {
    return false;
  }
  m_attempt.recording = fs::absolute(path).string();
  return true;
}

void AttemptLog::end(Json& result, AttemptState how) {
  if (m_ended) return;
  m_ended = true;
  m_attempt.state = result.contains("failure") ? AttemptState::not_assessed : how;
  m_attempt.ended = utc_now();
  result["attempt"] = {{"number", m_attempt.number},      {"uuid", m_attempt.uuid},
                       {"mode", name_of(m_attempt.mode)}, {"state", name_of(m_attempt.state)},
                       {"started", m_attempt.started},    {"ended", m_attempt.ended}};
  // The recording first: with its end mark it is the attempt, whatever happens to the store.
  if (const std::string fault = m_session.finish(result); !fault.empty()) notice(fault);
  if (m_store) {
    const std::string text = result.dump(-1, ' ', false, Json::error_handler_t::replace);
    fill_from_result(text, m_attempt);
    m_attempt.ticks = m_session.state().tick;
    m_attempt.seconds = double(m_attempt.ticks) * sim::kTick;
    m_attempt.trace = m_session.trace_bytes();
    const training::Kept kept = m_store->end(m_attempt, m_lock);
    result["attempt"]["number"] = m_attempt.number;
    if (!kept.in_database && kept.anywhere()) result["attempt"]["kept_in"] = kept.file.string();
    take_notices();
  }
  std::vector<std::string> notices = m_notices;
  for (const std::string& warning : m_session.warnings()) notices.push_back(warning);
  if (!notices.empty()) result["notices"] = notices;
}

std::string AttemptLog::warning() const {
  if (const std::string& fault = m_session.recording_failure(); !fault.empty()) return fault;
  if (const std::vector<std::string> warnings = m_session.warnings(); !warnings.empty()) return warnings.back();
  return m_notices.empty() ? std::string() : m_notices.back();
}

/// The store has told its own on stderr.
void AttemptLog::take_notices() {
  if (!m_store) return;
  const std::vector<std::string>& all = m_store->notices();
  m_notices.insert(m_notices.end(), all.begin() + std::ptrdiff_t(std::min(m_notices_taken, all.size())), all.end());
  m_notices_taken = all.size();
}

void AttemptLog::notice(const std::string& text) {
  core::log::warn("{}", text);
  m_notices.push_back(text);
}

}  // namespace trocar::attempt
