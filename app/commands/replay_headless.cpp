#include "commands/replay_headless.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <trocar/attempt/footage.hpp>
#include <trocar/attempt/interrupt.hpp>
#include <trocar/attempt/progress.hpp>
#include <trocar/attempt/session.hpp>
#include <trocar/attempt/verification/result_check.hpp>
#include <trocar/attempt/verification/state_check.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/log.hpp>
#include <trocar/core/text.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/pictures/pictures.hpp>
#include <trocar/pictures/shot_moments.hpp>

#include "commands/command.hpp"

namespace trocar::app {
namespace {

constexpr std::size_t kKeyframesPerShot = 50;

/// Pictures and a film of a part of the recording, as its States come by.
class Camera {
 public:
  Camera(const attempt::Lesson& lesson, const ReplayOptions& o, const pictures::FilmPlan& plan)
      : m_plan(plan), m_view(view_of(o.camera, view::orbit_around(lesson.model))) {
    if (!o.video.empty())
      m_video = pictures::Video::open(o.video, o.size);  // first: what it lacks is told before any work
    if (!o.shots.empty() || m_video) m_pictures = std::make_unique<pictures::Pictures>(lesson.model, o.size, o.look);
    if (!o.shots.empty()) m_shots = std::make_unique<pictures::Shots>(*m_pictures, o.shots);
    if (!o.data.folder.empty()) m_data.emplace(lesson.model, o.data, o.size, o.look);
  }

  bool wants_nothing_after(std::uint64_t tick) const { return tick >= m_plan.to; }
  bool shows(std::uint64_t tick) const { return tick >= m_plan.from && tick <= m_plan.to; }

  void shot(const sim::State& state, const std::string& what, const std::string& text) {
    if (m_shots) m_shots->take_outside(state, what, text, m_view);
  }
  /// The film's pictures that show `state`: none, or several in slow motion.
  void film(const sim::State& state) {
    if (!due(state.tick)) return;
    const render::Image image = m_pictures->draw(state, m_view);
    while (due(state.tick)) {
      m_video->add(image);
      ++m_picture;
    }
  }
  /// The part's frames for research.
  void data(const sim::State& state) {
    if (data_due(state.tick)) m_data->add(state, m_view);
  }
  bool data_due(std::uint64_t tick) const { return m_data && shows(tick) && m_data->due(tick); }
  bool due(std::uint64_t tick) const {
    return m_video && m_picture < m_plan.pictures() && m_plan.tick(m_picture) <= tick;
  }
  std::uint64_t next_tick() const { return m_plan.tick(m_picture); }
  bool filming() const { return m_video && m_picture < m_plan.pictures(); }

  void finish(Json& out) {
    if (m_shots) {
      m_shots->write_index();
      out["pictures"] = m_shots->files();
      out["picture_index"] = m_shots->index_file();
    }
    if (m_data) out["data"] = m_data->finish();
    if (!m_video) return;
    if (m_picture == 0) return core::log::warn("no film: the recording ended before its first picture");
    if (!m_video->finish())
      throw core::EnvironmentLacks(tr("no film: {} could not be written; is the disk full?", m_video->path()));
    out["video"] = m_video->path();
    out["video_pictures"] = m_picture;
    out["video_seconds"] = double(m_picture) / pictures::kVideoRate;
  }

 private:
  pictures::FilmPlan m_plan;
  view::ViewOptions m_view;
  std::unique_ptr<pictures::Video> m_video;
  std::unique_ptr<pictures::Pictures> m_pictures;
  std::unique_ptr<pictures::Shots> m_shots;
  std::optional<pictures::DataFrames> m_data;
  std::uint64_t m_picture = 0;
};

/// At the part's ends, and of what moments_to_show() tells in between.
void take_shots(Camera& camera, const attempt::Session& session, const pictures::FilmPlan& plan) {
  const std::uint64_t tick = session.state().tick;
  if (!camera.shows(tick)) return;
  if (tick == plan.from) camera.shot(session.state(), "start", "the start");
  for (const pictures::ShotMoment& m : pictures::moments_to_show(session, plan.from))
    camera.shot(session.state(), m.what, m.text);
  if (tick == plan.to) camera.shot(session.state(), "end", "the end");
}

/// Empty, or why a recording whose States agree is not verified all the same.
std::string unfinished(const attempt::StateCheck& states, const attempt::Session& session,
                       const sim::Recording& recording) {
  if (!session.broken().empty())
    return tr("{}; the recording ends there. All {} state hashes until then agree", session.broken(), states.hashes());
  const std::uint64_t tick = session.state().tick, last = recording.inputs.size();
  if (tick < last) return tr("stopped at tick {} of {}; what was compared until then agrees", tick, last);
  if (recording.complete) return {};
  // Killed, or cut off between two blocks by somebody: nothing tells which, nor what is missing.
  if (recording.interrupted)
    return tr("verified up to tick {}; the recording ends early, without an end mark", states.last_good());
  return tr("the file is damaged ({}); what could be read, until tick {}, agrees", recording.damage, last);
}

void judge(const attempt::StateCheck& states, const attempt::Session& session, const sim::Recording& recording,
           Json& out) {
  states.describe(out);
  std::string fault = states.fault();
  if (fault.empty()) fault = unfinished(states, session, recording);
  if (fault.empty()) {
    const attempt::ResultCheck result =
        attempt::check_result(recording, session.lesson(), session.result(attempt::was_aborted(recording)));
    fault = result.difference;
    out["score_compared"] = result.not_compared.empty();
    if (!result.not_compared.empty()) out["score_not_compared"] = result.not_compared;
  }
  out["verified"] = fault.empty();
  if (!fault.empty()) out["difference"] = fault;
}

/// The inputs again. With --verify all of them, otherwise as far as pictures are wanted.
Json play_inputs(const attempt::Lesson& lesson, const sim::Recording& recording, const ReplayOptions& o) {
  const pictures::FilmPlan plan = plan_of(o, recording.inputs.size());
  Camera camera(lesson, o, plan);
  attempt::Session session(lesson);
  session.set_scored(training::mode_in_header(recording.header.metadata_json) !=
                     training::AttemptMode::familiarisation);
  attempt::StateCheck states(lesson.model, recording);
  attempt::Progress progress(0, recording.inputs.size());
  const bool to_the_end = o.verify || o.to < 0;
  bool good = !o.verify || states.check(session);
  attempt::catch_interrupts();
  for (;;) {
    take_shots(camera, session, plan);
    camera.film(session.state());
    camera.data(session.state());
    const std::uint64_t tick = session.state().tick;
    const bool enough = !to_the_end && camera.wants_nothing_after(tick);
    if (!good || enough || tick >= recording.inputs.size() || !session.broken().empty() || attempt::interrupted())
      break;
    session.advance(recording.inputs[tick]);
    good = !o.verify || states.check(session);
    progress.at(tick);
  }
  Json out = session.result(false);
  out["played"] = "inputs";
  if (o.verify) judge(states, session, recording, out);
  camera.finish(out);
  return out;
}

Json play_keyframes(const attempt::Lesson& lesson, const sim::Recording& recording, const ReplayOptions& o) {
  core::log::warn("{}: made with another version of the physics or scene; showing its keyframes", o.file);
  attempt::Footage footage(lesson.model, recording.keyframes);
  const pictures::FilmPlan plan = plan_of(o, footage.last());
  Camera camera(lesson, o, plan);
  Json out{{"played", "keyframes"}, {"keyframes", recording.keyframes.size()}};
  std::size_t shown = 0;
  for (std::size_t i = 0; i < footage.count(); ++i) {  // all are read, so that one that does not fit is told
    const std::uint64_t tick = recording.keyframes[i].tick;
    const sim::State& state = footage.at(tick);
    if (!footage.sound()) break;
    if (camera.shows(tick) && (shown++ % kKeyframesPerShot == 0 || i + 1 == recording.keyframes.size()))
      camera.shot(state, "keyframe", tr("keyframe {} of {}", i + 1, recording.keyframes.size()));
  }
  if (!footage.sound()) throw core::BadInput({{{o.file, 0, 0}, "its keyframes do not fit the scene as it is now"}});
  while (camera.filming()) {
    sim::State state = footage.at(camera.next_tick());
    state.tick = camera.next_tick();
    camera.film(state);
  }
  for (std::uint64_t tick = plan.from; !o.data.folder.empty() && tick <= plan.to; ++tick) {
    if (!camera.data_due(tick)) continue;
    sim::State state = footage.at(tick);
    state.tick = tick;
    camera.data(state);
  }
  camera.finish(out);
  return out;
}

}  // namespace

pictures::FilmPlan plan_of(const ReplayOptions& o, std::uint64_t last) {
  const auto ticks = [last](double seconds) {  // not a number: the end
    return seconds * double(core::kTicksPerSecond) < double(last)
               ? std::uint64_t(seconds * double(core::kTicksPerSecond) + 0.5)
               : last;
  };
  const pictures::FilmPlan plan{ticks(o.from), o.to < 0 ? last : ticks(o.to), o.speed};
  const bool past = !(o.from * double(core::kTicksPerSecond) <= double(last));
  if (past || plan.from > plan.to)
    throw core::BadInput({{{past ? "--from" : "--to", 0, 0},
                           o.to < 0 ? tr("expected a part of the recording's {:.3f} s, got {} to the end",
                                         double(last) * core::kTick, o.from)
                                    : tr("expected a part of the recording's {:.3f} s, got {} to {}",
                                         double(last) * core::kTick, o.from, o.to)}});
  return plan;
}

Json replay_headless(const attempt::Lesson& lesson, const sim::Recording& recording, const ReplayOptions& options) {
  if (lesson.model.hash == recording.header.model_hash) return play_inputs(lesson, recording, options);
  if (!options.verify) return play_keyframes(lesson, recording, options);
  return {{"verified", false},
          {"difference", tr("made with another version of the physics or scene (model {}, here {}): nothing "
                            "to verify against",
                            core::hex(recording.header.model_hash), core::hex(lesson.model.hash))}};
}

}  // namespace trocar::app
