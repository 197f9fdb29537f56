#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <trocar/attempt/session.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/log.hpp>
#include <trocar/core/text.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/recording/keyframe.hpp>
#include <trocar/training/exercise/exercise_hash.hpp>
#include <trocar/training/observe/hands.hpp>

namespace trocar::attempt {
namespace {

struct FlagName {
  std::uint32_t bit;
  const char* name;
  const char* warning = nullptr;  ///< what it means for who practises; null: nothing, or the result says it
  const char* missing = nullptr;  ///< what the result lacks since; null: nothing
};
constexpr FlagName kFlags[] = {
    {tissue::StepReport::kNonFinite, "non_finite"},
    {tissue::StepReport::kInverted, "inverted_cells"},
    {tissue::StepReport::kBadLoad, "bad_load", "A force on the tissue was not finite and was left out."},
    {tissue::StepReport::kIndefinite, "indefinite"},
    {sim::StepReport::kTooManyLoads, "too_many_loads", "There are too many contacts at once: some are left out."},
    {sim::StepReport::kBadInput, "bad_input",
     "An input device sent a value that is not finite, or chose an instrument that is not in the rack. "
     "That hand did not move."},
    {sim::StepReport::kRecordsFull, "book_full",
     "No more clips, cuts, wounds or stitches can be recorded: further clips are lost, blades do not cut, tears stop "
     "growing. Restart the exercise.",
     "Some clips, cuts, wounds, seals or stitches were not recorded: the list of their kind was full. They are not "
     "assessed."},
    {sim::StepReport::kHeatFull, "heat_full",
     "No more heated tissue can be computed. The author can raise bricks or awake under energy in the scene."},
    {sim::StepReport::kDropsFull, "drops_full",
     "There are too many drops of fluid: further fluid goes straight into the pool."},
    {sim::StepReport::kBloodFlow, "blood_flow", "The blood flow has no solution and stopped. Restart the exercise."},
    {tissue::StepReport::kBeyondLinear, "beyond_linear",
     "An organ has turned further than its model allows: its forces and its shape are inaccurate."},
    {sim::StepReport::kEventsFull, "events_full",
     "More happened at one moment than can be counted: some of its events are not assessed.",
     "Some events were not recorded: more happened in one millisecond than can be counted. They are not assessed."},
};

}  // namespace

std::filesystem::path keep_older(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error) || std::filesystem::file_size(path, error) == 0) return {};
  std::filesystem::path kept;
  for (int n = 1; kept.empty() || std::filesystem::exists(kept, error); ++n)
    kept = path.parent_path() / fmt::format("{}-older-{}{}", path.stem().string(), n, path.extension().string());
  std::filesystem::rename(path, kept, error);
  if (error)
    throw core::EnvironmentLacks(
        tr("{} exists and cannot be renamed ({}): record to another file, or move it", path.string(), error.message()));
  core::log::info("{} existed and was renamed to {}", path.string(), kept.string());
  return kept;
}

std::vector<std::string> flag_names(std::uint32_t flags) {
  std::vector<std::string> names;
  for (const FlagName& f : kFlags)
    if (flags & f.bit) names.emplace_back(f.name);
  return names;
}

Session::Session(const Lesson& lesson, int threads)
    : m_lesson(lesson),
      m_pool(threads),
      m_state(sim::initial_state(lesson.model)),
      m_work(sim::make_work(lesson.model, &m_pool)),
      m_monitor(lesson.monitor()),
      m_trace(lesson.model) {
  for (size_t t = 0; t < lesson.model.hands.size(); ++t) m_tip[t] = training::tip_of(lesson.model, m_state, t);
  if (m_monitor) m_steps_done.resize(m_monitor->steps().size());
}

void Session::record(const std::filesystem::path& path, const training::Attempt& attempt) {
  sim::RecordingHeader header;
  header.model_hash = m_lesson.model.hash;
  header.seed = m_lesson.seed;
  header.exercise = m_lesson.name;
  header.program_version = TROCAR_VERSION;
  Json note{{"trainee", attempt.trainee}, {"input", attempt.input},   {"started", attempt.started},
            {"uuid", attempt.uuid},       {"number", attempt.number}, {"mode", name_of(attempt.mode)},
            {"title", attempt.title}};
  if (m_lesson.exercise) note[training::kExerciseHash] = core::hex(training::judgement_hash(*m_lesson.exercise));
  header.metadata_json = note.dump(-1, ' ', false, Json::error_handler_t::replace);
  m_writer = std::make_unique<sim::RecordingWriter>(path, header);
  m_recording = path;
  m_writer->hash(m_state.tick, mark());
  m_writer->keyframe(m_state.tick, sim::display_bytes(m_lesson.model, m_state));
  m_writer->flush();
}

const sim::StepReport& Session::advance(const sim::Input& input) {
  m_moments.clear();
  if (!m_broken.empty()) return m_report;
  if (m_writer) m_writer->tick(m_state.tick, input);
  m_inputs_hash = core::hash_bytes(&input, sizeof input, m_inputs_hash);
  m_report = sim::step(m_lesson.model, input, m_state, m_work);
  if (m_beside) m_beside->advance(input);
  const std::uint32_t flags = lasting(m_report.flags);
  if (m_report.fine()) warn_of(flags & ~m_flags);
  m_flags |= flags;
  if (m_report.fine())
    watch_tick();
  else
    fail();
  if (m_writer && m_state.tick % sim::kHashEvery == 0) m_writer->hash(m_state.tick, mark());
  if (m_writer && m_state.tick % sim::kKeyframeEvery == 0)
    m_writer->keyframe(m_state.tick, sim::display_bytes(m_lesson.model, m_state));
  note_failure();
  return m_report;
}

/// A cell that is pressed flat and pushed open again is nothing to be told, unless it lasts.
std::uint32_t Session::lasting(std::uint32_t flags) {
  constexpr std::uint64_t kLasts = core::kTicksPerSecond;
  m_inverted_for = flags & tissue::StepReport::kInverted ? m_inverted_for + 1 : 0;
  return m_inverted_for < kLasts ? flags & ~std::uint32_t(tissue::StepReport::kInverted) : flags;
}

/// What everybody who watches makes of a tick.
void Session::watch_tick() {
  for (size_t t = 0; t < m_lesson.model.hands.size(); ++t) {
    const Vec3d tip = training::tip_of(m_lesson.model, m_state, t);
    m_path[t] += length(tip - m_tip[t]);
    m_tip[t] = tip;
  }
  if (m_monitor) m_monitor->update(m_lesson.model, m_state, m_report);
  if (m_monitor && m_monitor->rules().events().lost()) {
    warn_of(sim::StepReport::kEventsFull & ~m_flags);
    m_flags |= sim::StepReport::kEventsFull;
  }
  m_trace.update(m_lesson.model, m_state, m_report);
  if (m_exercise_from < 0 && m_monitor && m_monitor->seconds() > 0)
    m_exercise_from = double(m_state.tick) * sim::kTick - m_monitor->seconds();
  collect_moments();
  keep_moments();
}

/// Nothing that is not finite was so all at once: before it, tissue moves, tears and presses as no hand made it. How
/// long before nobody can say, so the attempt is not assessed at all, and no error of it is kept.
void Session::fail() {
  m_broken = tr(
      "The simulation failed at {:.3f} s (body {}, node {}). This is a fault of the program, not of the trainee: the "
      "attempt is not assessed.",
      double(m_state.tick) * sim::kTick, sim::name_of(m_lesson.model, m_report.first_bad_body),
      m_report.first_bad_index);
  std::erase_if(m_kept, [](const KeptMoment& k) { return k.moment.what == "error"; });
  core::log::error("{}", m_broken);
}

void Session::warn_of(std::uint32_t flags) {
  if (flags == 0) return;
  for (const FlagName& f : kFlags) {
    if (!(flags & f.bit) || !f.warning) continue;
    const std::string warning = tr("{} (at {:.1f} s)", tr(f.warning), double(m_state.tick) * sim::kTick);
    core::log::warn("{}", warning);
    const std::lock_guard lock(m_failure_lock);
    m_warnings.push_back(warning);
  }
}

std::vector<std::string> Session::warnings() const {
  const std::lock_guard lock(m_failure_lock);
  return m_warnings;
}

void Session::note_failure() {
  if (!m_writer || m_writer->failure().empty()) return;
  const std::lock_guard lock(m_failure_lock);
  if (!m_recording_failure.empty()) return;
  m_recording_failure = m_writer->failure();
  core::log::error("{}", m_recording_failure);
}

std::string Session::recording_failure() const {
  const std::lock_guard lock(m_failure_lock);
  return m_recording_failure;
}

std::vector<std::uint8_t> Session::trace_bytes() const { return training::to_bytes(m_trace.trace()); }

void Session::keep_moments() {
  for (const Moment& m : m_moments) {
    if (m.what == "closed-empty") continue;
    m_moments_lost = m_moments_lost || m_kept.size() >= kMaxKept;
    if (m_moments_lost) return;
    m_kept.push_back({m, {}});
    if (m_kept.size() <= kMaxLooks) m_kept.back().display = sim::display_bytes(m_lesson.model, m_state);
  }
}

std::uint64_t Session::mark() const {
  core::Hasher hasher;
  hasher.add(sim::hash_of(m_state));
  hasher.add(m_inputs_hash);
  return hasher.value();
}

void Session::add_moment(const char* what, int tool, std::string text) {
  m_moments.push_back({m_state.tick, what, tool, std::move(text)});
}

namespace {

/// A scene without hands has no instrument to name: a declaration happens there, too.
std::string in_words(const sim::Event& e, const sim::Model& model, const sim::State& s) {
  const sim::EventWords& words = sim::words_of(e.kind);
  const bool by_hand = e.hand >= 0 && size_t(e.hand) < model.hands.size();
  const std::string tool = by_hand ? model.tool(s, size_t(e.hand)).name : "endoscope";
  return fmt::format(fmt::runtime(words.text), fmt::arg("tool", tool),
                     fmt::arg("hand", by_hand ? model.hands[size_t(e.hand)].name : tool),
                     fmt::arg("body", words.has_body ? sim::name_of(model, e.body) : std::string()));
}

}  // namespace

void Session::collect_moments() {
  const sim::Model& model = m_lesson.model;
  for (int i = 0; i < m_report.event_count; ++i) {
    const sim::Event& e = m_report.events[i];
    ++m_counts[size_t(e.kind)];
    if (e.kind != sim::Event::none) add_moment(sim::words_of(e.kind).name, e.hand, in_words(e, model, m_state));
  }
  for (size_t t = 0; t < model.hands.size(); ++t) {
    const interactions::ToolState& tool = m_state.tools[t];
    const interactions::Abilities& can = model.tool(m_state, t).can();
    const bool empty = can.grip && !can.coagulate && tool.holds == 0 && tool.aperture < 0.05;
    if (empty && !m_closed_empty[t])
      add_moment("closed-empty", int(t), model.tool(m_state, t).name + " closed on nothing");
    m_closed_empty[t] = empty;
  }
  if (!m_monitor) return;
  for (size_t i = 0; i < m_steps_done.size(); ++i) {
    const training::StepStatus& step = m_monitor->steps()[i];
    if (step.done && !m_steps_done[i]) add_moment("step-done", -1, step.name);
    m_steps_done[i] = step.done;
  }
  for (; m_errors_told < m_monitor->errors().size(); ++m_errors_told) {
    const training::ErrorMade& error = m_monitor->errors()[m_errors_told];
    add_moment("error", -1, fmt::format("{}: {}", error.code, error.meaning));
    m_moments.back().code = error.code;
    m_moments.back().hint = error.hint;
  }
}

Json Session::not_recorded() const {
  Json all = Json::array();
  for (const FlagName& f : kFlags)
    if ((m_flags & f.bit) && f.missing) all.push_back(tr(f.missing));
  if (m_moments_lost) all.push_back(tr("Some events were not recorded: the list of moments ends after {}.", kMaxKept));
  if (m_trace.marks_lost())
    all.push_back(
        tr("Some events were not recorded: the motion plots mark only the first {}.", training::kMaxTraceMarks));
  if (m_trace.full()) all.push_back(tr("The end of the motion was not recorded: there is room for four hours."));
  return all;
}

Json Session::result(bool interrupted) const {
  const sim::Model& model = m_lesson.model;
  const bool failed = !m_broken.empty();
  const bool passed = !interrupted && m_monitor && m_monitor->score().passed;
  Json r;
  r["exercise"] = m_lesson.name;
  r["seed"] = m_lesson.seed;
  r["passed"] = m_monitor && m_scored && !failed ? Json(passed) : Json(nullptr);
  if (failed) r["failure"] = m_broken;
  if (interrupted) r["interrupted"] = true;
  // Two clocks: all that was simulated, and what counts, from the first motion of an instrument to the last goal.
  r["simulated_seconds"] = double(m_state.tick) * sim::kTick;
  if (m_monitor) {
    r["exercise_seconds"] = m_monitor->seconds();
    r["assessment"] = failed ? Json(nullptr) : Json::parse(m_monitor->result_json());
  }
  if (m_exercise_from >= 0) r["exercise_from_s"] = m_exercise_from;
  r["metrics"] = Json::parse(training::metrics_json(m_trace.trace(), metrics_options()));
  Json tools = Json::array();
  for (size_t t = 0; t < model.hands.size(); ++t)
    tools.push_back({{"name", model.tool(m_state, t).name},
                     {"trocar", model.hands[t].name},
                     {"path_length_mm", m_path[t] * 1000},
                     {"clips_left", m_state.tools[t].clips_left},
                     {"slips", m_state.tools[t].slipped}});
  r["instruments"] = tools;
  r["grasps"] = m_counts[sim::Event::grasped];
  r["clips"] = m_counts[sim::Event::clipped];
  r["clips_dropped"] = m_counts[sim::Event::dropped_clip];
  r["cuts"] = m_counts[sim::Event::cut];
  r["tears"] = m_counts[sim::Event::torn];
  Json moments = Json::array();
  for (const KeptMoment& k : m_kept)
    moments.push_back({{"tick", k.moment.tick}, {"what", k.moment.what}, {"text", k.moment.text}});
  r["moments"] = moments;
  r["flags"] = flag_names(m_flags);
  if (Json missing = not_recorded(); !missing.empty()) r["not_recorded"] = std::move(missing);
  r["tissue_survived"] = !failed;
  r["ticks"] = m_state.tick;
  r["state_hash"] = core::hex(sim::hash_of(m_state));
  r["model_hash"] = core::hex(model.hash);
  if (m_writer) r["recording"] = m_recording.string();
  return r;
}

namespace {

/// Is this error made by touching something with the lens?
bool is_lens_touch(const training::Penalty& penalty) {
  const scene::JsonMember* on = penalty.part.value.find("on");
  const scene::JsonMember* event = on ? on->value.find("event") : nullptr;
  return event && event->value.text == "lens_touched";
}

/// What the exercise tells of the endoscope. @param from  when its clock began [s]
training::CameraWatch camera_watch(const training::Exercise& exercise, const training::Monitor& monitor, double from) {
  training::CameraWatch watch;
  watch.on_target = monitor.on_target_share();
  const auto counts = [&](const training::Penalty& p) { return is_lens_touch(p); };
  if (std::any_of(exercise.penalties.begin(), exercise.penalties.end(), counts)) {
    watch.lens_touches = 0;
    for (const training::ErrorMade& e : monitor.errors()) {
      const training::Penalty* penalty = exercise.penalty(e.code);
      if (penalty && is_lens_touch(*penalty)) ++watch.lens_touches;
    }
  }
  std::vector<double> times;
  for (const training::StepStatus& step : monitor.steps())
    if (step.done && !step.side.empty()) times.push_back(step.at);
  std::sort(times.begin(), times.end());
  double before = std::max(0.0, from);
  for (const double at : times) {
    watch.target_seconds.push_back(std::max(0.0, at - before));
    before = at;
  }
  return watch;
}

}  // namespace

/// Motion is measured up to the last step that was done; an attempt that is not finished, to its end. Forces are held
/// against the limits that its errors are held against.
training::MetricsOptions Session::metrics_options() const {
  training::MetricsOptions options;
  if (m_lesson.exercise) {
    double &pull = options.force_limits[training::kPull], &pinch = options.force_limits[training::kPinch];
    pull = m_lesson.exercise->limit("pull_limit_N", pull);
    pinch = m_lesson.exercise->limit("pinch_limit_N", pinch);
  }
  if (m_monitor && m_lesson.exercise && m_lesson.model.hands.empty())
    options.camera = camera_watch(*m_lesson.exercise, *m_monitor, m_exercise_from);
  if (!m_monitor || !m_monitor->finished() || m_exercise_from < 0) return options;
  options.end = 0;
  for (const training::StepStatus& step : m_monitor->steps()) options.end = std::max(options.end, step.at);
  return options;
}

void Session::set_scored(bool scored) {
  m_scored = scored;
  if (m_state.tick == 0) m_monitor = m_lesson.monitor(scored);
}

std::string Session::finish(const Json& result) {
  if (!m_writer) return {};
  if (m_state.tick % sim::kHashEvery != 0) m_writer->hash(m_state.tick, mark());
  m_writer->finish(result.dump(-1, ' ', false, Json::error_handler_t::replace));
  note_failure();
  m_writer.reset();
  if (const std::string fault = recording_failure(); !fault.empty()) return fault;
  const int file = open(m_recording.c_str(), O_RDONLY | O_CLOEXEC);  // a power cut takes nothing back
  const bool safe = file >= 0 && fsync(file) == 0;
  if (file >= 0) close(file);
  return safe ? "" : fmt::format("recording {}: {}", m_recording.string(), std::strerror(errno));
}

}  // namespace trocar::attempt
