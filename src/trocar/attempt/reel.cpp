#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include <trocar/attempt/footage.hpp>
#include <trocar/attempt/reel.hpp>
#include <trocar/core/text.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/sim/recording/shown_difference.hpp>
#include <trocar/training/store/json_fields.hpp>

namespace trocar::attempt {
namespace {

constexpr int kSlice = 20;                         // ticks between looks at what is wanted
constexpr std::uint64_t kChaseWhilePlaying = 600;  // ticks; what is further comes from keyframes
constexpr std::size_t kRecent = 48;

TimelineMark::Kind kind_of(const std::string& what) {
  if (what == "error") return TimelineMark::Kind::error;
  if (what == "step-done") return TimelineMark::Kind::step;
  return TimelineMark::Kind::event;
}

int threads_of(int wanted) {
  return wanted > 0 ? wanted : std::max(1, core::default_thread_count() - 1);  // one core draws
}

std::uint64_t tick_of(const Json& at_seconds) {
  const double seconds = at_seconds.is_number() ? at_seconds.get<double>() : -1;
  return seconds >= 0 && seconds < 1e6 ? std::uint64_t(std::llround(seconds * double(core::kTicksPerSecond))) : 0;
}

/// The members of a list that are objects: the result is a file's content, so anything may stand there.
std::vector<Json> objects(const Json& parent, const char* key) {
  std::vector<Json> out;
  const auto list = parent.find(key);
  if (list == parent.end() || !list->is_array()) return out;
  for (const Json& entry : *list)
    if (entry.is_object()) out.push_back(entry);
  return out;
}

bool is_done(const Json& step) {
  const auto flag = step.find("done");
  return flag != step.end() && flag->is_boolean() && flag->get<bool>() && step.contains("at_s");
}

}  // namespace

const GuideState* Findings::guide_at(std::uint64_t tick) const {
  const auto after = std::upper_bound(guide.begin(), guide.end(), tick,
                                      [](std::uint64_t t, const GuideState& g) { return t < g.tick; });
  return after == guide.begin() ? nullptr : &*std::prev(after);
}

Findings findings_of_result(const std::string& result_json) {
  Findings found;
  const Json result = training::json_in(result_json);
  if (!result.is_object() || !result.contains("assessment") || !result["assessment"].is_object()) return found;
  const Json& assessment = result["assessment"];
  std::vector<std::pair<std::uint64_t, std::size_t>> done;
  for (const Json& step : objects(assessment, "steps")) {
    training::StepStatus& status = found.steps.emplace_back();
    status.name = training::text_in(step, "name");
    status.side = training::text_in(step, "side");
    if (!is_done(step)) continue;
    done.emplace_back(tick_of(step["at_s"]), found.steps.size() - 1);
    found.marks.push_back({TimelineMark::Kind::step, done.back().first, status.name});
  }
  std::stable_sort(done.begin(), done.end());
  GuideState state{0, 0, std::vector<char>(found.steps.size(), GuideState::kOpen)};
  if (!found.steps.empty()) found.guide.push_back(state);
  for (const auto& [tick, step] : done) {
    state.tick = tick;
    state.done[step] = GuideState::kDone;
    state.current = int(std::find(state.done.begin(), state.done.end(), GuideState::kOpen) - state.done.begin());
    found.guide.push_back(state);
  }
  for (const Json& error : objects(assessment, "errors"))
    found.marks.push_back({TimelineMark::Kind::error, tick_of(error.value("at_s", Json())),
                           training::text_in(error, "code") + ": " + training::text_in(error, "meaning")});
  sort_marks(found.marks);
  return found;
}

/// The attempt that is done again from the start, and the way to where the player looks.
struct Reel::Explorer {
  Session session;  ///< watched by the judge; goes through once
  KeptStates kept;
  RecentStates recent{kRecent};
  core::ThreadPool pool;
  sim::State cursor;  ///< where the player looks, or on the way there
  sim::Work work;
  std::size_t next_hash = 0;
  bool exhausted = false;
  std::uint64_t published = kNowhere;

  Explorer(const Lesson& lesson, const Options& o)
      : session(lesson, threads_of(o.threads)),
        kept(o.budget, o.spacing),
        pool(threads_of(o.threads)),
        cursor(session.state()),
        work(sim::make_work(lesson.model, &pool)) {
    kept.keep(session.state());
  }
};

Reel::Reel(const Lesson& lesson, const sim::Recording& recording, const Options& options)
    : m_lesson(lesson),
      m_recording(recording),
      m_options(options),
      m_replays(lesson.model.hash == recording.header.model_hash && !recording.inputs.empty()),
      m_last(m_replays                     ? recording.inputs.size()
             : recording.keyframes.empty() ? 0
                                           : recording.keyframes.back().tick),
      m_published(sim::initial_state(lesson.model)),
      m_told(findings_of_result(recording.result_json)),
      m_findings(m_replays ? Findings{} : m_told),
      m_thread([this] { m_replays ? loop() : loop_keyframes(); }) {}

Reel::~Reel() {
  {
    const std::lock_guard lock(m_lock);
    m_stop.store(true);
  }
  m_wake.notify_all();
  m_thread.join();
}

void Reel::look_at(std::uint64_t tick, bool playing) {
  tick = std::min(tick, m_last);
  const bool news = m_target.exchange(tick) != tick;
  m_playing.store(playing, std::memory_order_relaxed);
  if (!news) return;
  m_way.store(1, std::memory_order_relaxed);  // until the thread knows better
  const std::lock_guard lock(m_lock);
  m_wake.notify_one();
}

bool Reel::findings(std::uint64_t& version, Findings& to) const {
  const std::lock_guard lock(m_lock);
  if (m_version == version) return false;
  version = m_version;
  to = m_findings;
  if (!m_replays || complete()) return true;
  const std::uint64_t known = known_until();
  for (const TimelineMark& m : m_told.marks)
    if (m.tick > known) to.marks.push_back(m);
  return true;
}

void Reel::publish(const sim::State& state) {
  m_published.next() = state;
  m_published.publish();
}

void Reel::loop() {
  Explorer e(m_lesson, m_options);
  e.session.set_scored(training::mode_in_header(m_recording.header.metadata_json) !=
                       training::AttemptMode::familiarisation);
  m_spacing.store(e.kept.spacing());
  {
    const std::lock_guard lock(m_lock);
    if (e.session.monitor()) m_findings.steps = e.session.monitor()->steps();
    ++m_version;
  }
  note(e);
  while (!stopping()) {
    const std::uint64_t target = m_target.load();
    const bool playing = m_playing.load(std::memory_order_relaxed);
    if (approach(e, target, playing)) continue;
    if (explore(e)) continue;
    std::unique_lock lock(m_lock);
    m_wake.wait_for(lock, std::chrono::milliseconds(200), [&] { return stopping() || m_target.load() != target; });
  }
}

/// What the last tick of the watched attempt brought: hash, marks, guide.
void Reel::note(Explorer& e) {
  const Session& session = e.session;
  const std::uint64_t tick = session.state().tick;
  const std::vector<sim::HashMark>& hashes = m_recording.hashes;
  while (e.next_hash < hashes.size() && hashes[e.next_hash].tick < tick) ++e.next_hash;
  const bool differs =
      e.next_hash < hashes.size() && hashes[e.next_hash].tick == tick && hashes[e.next_hash].hash != session.mark();
  GuideState guide{tick, 0, {}};
  if (const training::Monitor* monitor = session.monitor()) {
    guide.current = monitor->current();
    for (const training::StepStatus& s : monitor->steps())
      guide.done.push_back(s.done ? GuideState::kDone : s.missed ? GuideState::kMissed : GuideState::kOpen);
  }
  const std::lock_guard lock(m_lock);
  m_known.store(tick, std::memory_order_release);
  for (const Moment& m : session.moments()) {
    if (std::string_view(m.what) == "closed-empty") continue;
    m_findings.marks.push_back({kind_of(m.what), tick, m.text});
    ++m_version;
  }
  const bool first = m_findings.guide.empty();
  if (session.monitor() &&
      (first || m_findings.guide.back().done != guide.done || m_findings.guide.back().current != guide.current)) {
    m_findings.guide.push_back(guide);
    ++m_version;
  }
  if (differs && m_findings.difference.empty()) {
    const std::string told = sim::told_difference(m_lesson.model, m_recording, session.state());
    m_findings.difference =
        tr("the repetition differs from the recording at {}{}{}", clock_text(tick), told.empty() ? "" : "; ", told);
    m_findings.marks.push_back({TimelineMark::Kind::damage, tick, m_findings.difference});
    ++m_version;
    const std::uint64_t agreed = e.next_hash > 0 ? hashes[e.next_hash - 1].tick : 0;
    m_differs_from.store(agreed + 1, std::memory_order_release);
  }
}

/// Some more of the first pass. False when there is no more.
bool Reel::explore(Explorer& e) {
  if (e.exhausted) return false;
  for (int i = 0; i < kSlice; ++i) {
    const std::uint64_t tick = e.session.state().tick;
    e.exhausted = tick >= m_last || !e.session.broken().empty() || m_differs_from.load() <= tick;
    if (e.exhausted) break;
    e.session.advance(m_recording.inputs[tick]);
    note(e);
    if (e.kept.wants(tick + 1)) {
      e.kept.keep(e.session.state());
      m_kept_bytes.store(e.kept.bytes(), std::memory_order_relaxed);
      m_spacing.store(e.kept.spacing(), std::memory_order_relaxed);
    }
    if (tick + 1 == m_target.load()) break;  // somebody may be waiting for just this one
  }
  if (!e.exhausted) return true;
  if (e.session.state().tick < m_last && m_differs_from.load() == kNowhere)  // the physics failed, then as now
    m_differs_from.store(e.session.state().tick + 1, std::memory_order_release);
  const std::lock_guard lock(m_lock);
  m_complete.store(true, std::memory_order_release);
  ++m_version;
  return false;
}

/// Some ticks of the way to `target`. False when there is nothing to do for it now.
bool Reel::approach(Explorer& e, std::uint64_t target, bool playing) {
  if (e.published == target) {
    m_way.store(0, std::memory_order_relaxed);
    return false;
  }
  if (target >= m_differs_from.load()) return false;  // keyframes have the word there
  const sim::State* best = e.cursor.tick <= target ? &e.cursor : nullptr;
  for (const sim::State* s : {e.kept.before(target), e.recent.before(target)})
    if (s && (!best || s->tick > best->tick)) best = s;
  const sim::State& front = e.session.state();
  if (front.tick >= best->tick && front.tick < target) {  // the first pass is on its way there
    m_way.store(target - front.tick, std::memory_order_relaxed);
    const bool more = explore(e);
    if (playing && front.tick <= target) {
      publish(front);
      e.published = front.tick;
    }
    return more;
  }
  if (front.tick == target) best = &front;
  if (playing && target - best->tick > kChaseWhilePlaying) return false;
  if (best != &e.cursor) e.cursor = *best;
  for (int i = 0; i < kSlice && e.cursor.tick < target; ++i) {
    sim::step(m_lesson.model, m_recording.inputs[e.cursor.tick], e.cursor, e.work);
    if (e.cursor.tick % kFrameTicks == 0) e.recent.keep(e.cursor);
  }
  m_way.store(target - e.cursor.tick, std::memory_order_relaxed);
  if (e.cursor.tick == target || playing) {
    publish(e.cursor);
    e.published = e.cursor.tick;
  }
  return true;
}

/// Clips, cuts and grips as they show in the keyframes, and the result's steps and errors.
void Reel::loop_keyframes() {
  Footage footage(m_lesson.model, m_recording.keyframes);
  int clips = 0, cuts = 0;
  std::array<int, sim::kMaxTools> holds{};
  for (std::size_t i = 0; i < footage.count() && !stopping(); ++i) {
    const std::uint64_t tick = m_recording.keyframes[i].tick;
    const sim::State& s = footage.at(tick);
    if (!footage.sound()) break;
    std::vector<TimelineMark> marks;
    const auto mark = [&](const char* text) { marks.push_back({TimelineMark::Kind::event, tick, text}); };
    if (i > 0 && s.clip_count > clips) mark("a clip closed");
    if (i > 0 && s.cut_count > cuts) mark("a cut");
    for (std::size_t t = 0; t < s.tools.size(); ++t) {
      if (i > 0 && s.tools[t].holds > 0 && holds[t] == 0) mark("an instrument grasped");
      if (i > 0 && s.tools[t].holds == 0 && holds[t] > 0) mark("an instrument let go");
      holds[t] = s.tools[t].holds;
    }
    clips = s.clip_count;
    cuts = s.cut_count;
    m_known.store(tick, std::memory_order_release);
    if (marks.empty()) continue;
    const std::lock_guard lock(m_lock);
    m_findings.marks.insert(m_findings.marks.end(), marks.begin(), marks.end());
    sort_marks(m_findings.marks);
    ++m_version;
  }
  const std::lock_guard lock(m_lock);
  if (!footage.sound())
    m_findings.difference =
        tr("the keyframes do not fit the present scene, from {} on", clock_text(footage.empty() ? 0 : footage.last()));
  m_complete.store(true, std::memory_order_release);
  ++m_version;
}

}  // namespace trocar::attempt
