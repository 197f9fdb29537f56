// trocar replay: does a recording again from its inputs, and with --verify compares every state hash on the way. A
// recording of another version of the physics is shown from its keyframes and cannot be verified.
#include <chrono>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/log.hpp>

#include "command.hpp"
#include "headless.hpp"
#include "json.hpp"
#include "pictures.hpp"
#include "sources.hpp"
#include "video.hpp"

namespace trocar::app {
namespace {

struct Options {
  std::string file, shots, video, size = "800x600", exercise;
  bool verify = false;
};

/// Compares the session with the recording's hashes as it passes them.
class Verifier {
 public:
  explicit Verifier(const std::vector<sim::HashMark>& marks) : m_marks(marks) {}

  /// False at the first difference.
  bool check(const Session& session) {
    const std::uint64_t tick = session.state().tick;
    while (m_next < m_marks.size() && m_marks[m_next].tick < tick) ++m_next;
    if (m_next == m_marks.size() || m_marks[m_next].tick != tick) return true;
    if (session.mark() != m_marks[m_next].hash) {
      m_differs_at = tick;
      return false;
    }
    ++m_agreed;
    m_last_good = tick;
    return true;
  }

  std::size_t agreed() const { return m_agreed; }
  bool differs() const { return m_differs_at != kNever; }
  std::string difference() const {
    if (m_differs_at == 0) return "the first state differs before any tick";
    return fmt::format("the state differs after tick {}; it agreed until tick {}", m_differs_at, m_last_good);
  }
  void describe(Json& out) const {
    out["hashes_compared"] = m_agreed + (differs() ? 1 : 0);
    if (!differs()) return;
    out["differs_between_ticks"] = {m_last_good, m_differs_at};
  }

 private:
  static constexpr std::uint64_t kNever = ~std::uint64_t(0);
  const std::vector<sim::HashMark>& m_marks;
  std::size_t m_next = 0, m_agreed = 0;
  std::uint64_t m_last_good = 0, m_differs_at = kNever;
};

Json head(const sim::Recording& recording, const Options& o) {
  Json out{{"recording", o.file},
           {"exercise", recording.header.exercise},
           {"program_version", recording.header.program_version},
           {"complete", recording.complete},
           {"interrupted", recording.interrupted}};
  if (!recording.damage.empty()) out["damage"] = recording.damage;
  return out;
}

/// Pictures of a recording whose physics is not ours.
Json play_keyframes(const Lesson& lesson, const sim::Recording& recording, const Options& o, PictureSize size) {
  core::log::warn("{}: made with another version of the physics or scene; showing its keyframes", o.file);
  Json out{{"played", "keyframes"}, {"keyframes", recording.keyframes.size()}};
  std::unique_ptr<Pictures> pictures;
  std::unique_ptr<Shots> shots;
  std::unique_ptr<Video> video;
  if (!o.shots.empty() || !o.video.empty()) pictures = std::make_unique<Pictures>(lesson.model, size);
  if (!o.shots.empty()) shots = std::make_unique<Shots>(*pictures, o.shots);
  if (!o.video.empty()) video = Video::open(o.video, size);
  sim::State state = sim::initial_state(lesson.model);
  std::uint64_t frames = 0;
  for (std::size_t i = 0; i < recording.keyframes.size(); ++i) {
    const sim::Keyframe& key = recording.keyframes[i];
    if (!sim::restore_display(lesson.model, key.bytes, state))
      throw core::BadInput({{{o.file, 0, 0}, "its keyframes do not fit the scene as it is now"}});
    if (shots && (i % 50 == 0 || i + 1 == recording.keyframes.size()))
      shots->take(state, "keyframe", fmt::format("keyframe {} of {}", i + 1, recording.keyframes.size()));
    if (!video) continue;
    const render::Image image = pictures->draw(state);
    for (; frames * 1000 < (key.tick + sim::kKeyframeEvery) * kVideoRate; ++frames) video->add(image);
  }
  if (shots) {
    shots->write_index();
    out["pictures"] = shots->files();
  }
  if (video && video->finish()) out["video"] = video->path();
  return out;
}

Json play(const Lesson& lesson, const sim::Recording& recording, const Options& o, PictureSize size) {
  Session session(lesson);
  ReplaySource source(recording.inputs);
  Verifier verifier(recording.hashes);
  bool good = !o.verify || verifier.check(session);
  Leftovers left = Json::object();
  if (good)
    left = run_headless(session, source, {o.shots, o.video, size},
                        [&] { return good = !o.verify || verifier.check(session); });
  Json out = session.result(false);
  out["played"] = "inputs";
  if (o.verify) {
    const bool sound = recording.complete || recording.interrupted;  // a killed attempt is what it is
    const bool verified = good && session.broken().empty() && verifier.agreed() > 0 && sound;
    out["verified"] = verified;
    verifier.describe(out);
    if (!good) out["difference"] = verifier.difference();
    if (good && verifier.agreed() == 0) out["difference"] = "the recording holds no state hash to compare";
    if (good && !sound)
      out["difference"] = fmt::format("the file is damaged ({}); what could be read, until tick {}, agrees",
                                      recording.damage, recording.inputs.size());
  }
  out.update(left);
  return out;
}

int say(const Options& o, const Json& result, bool json) {
  const bool failed = o.verify && !result.value("verified", false);
  if (json) {
    print(result);
  } else if (o.verify) {
    fmt::print("{}: {}\n", o.file,
               failed ? result.value("difference", std::string("not verified"))
                      : fmt::format("verified, {} hashes", result["hashes_compared"].get<std::size_t>()));
  } else {
    fmt::print("{}: {} ticks\n", o.file, result.value("ticks", std::uint64_t(0)));
  }
  return failed ? core::kGoalNotReached : core::kDone;
}

int replay(const Options& o, bool json) {
  const PictureSize size = parse_size(o.size);
  const sim::Recording recording = sim::read_recording(o.file);
  if (!recording.damage.empty()) core::log::warn("{}: {}", o.file, recording.damage);
  const std::unique_ptr<Lesson> lesson = load_lesson(o.exercise.empty() ? recording.header.exercise : o.exercise);
  Json result = head(recording, o);
  if (lesson->model.hash == recording.header.model_hash) {
    result.update(play(*lesson, recording, o, size));
  } else if (o.verify) {
    result["verified"] = false;
    result["difference"] =
        fmt::format("made with another version of the physics or scene (model {}, here {}): nothing to verify against",
                    hex(recording.header.model_hash), hex(lesson->model.hash));
  } else {
    result.update(play_keyframes(*lesson, recording, o, size));
  }
  return say(o, result, json);
}

}  // namespace

void add_replay(CLI::App& program, Chosen& chosen) {
  auto o = std::make_shared<Options>();
  CLI::App* c =
      add_command(program, chosen, "replay", "Do a recording again, and verify it", "trocar replay a.rec --verify");
  c->add_option("recording", o->file, "a recording (train --record)")->required();
  c->add_flag("--verify", o->verify, "compare the model's and every state's hash; exit 1 where they differ");
  c->add_option("--exercise", o->exercise, "where the recording's exercise is now, if it was a path that moved");
  c->add_option("--shots", o->shots, "write pictures to this folder");
  c->add_option("--video", o->video, "write a film (needs ffmpeg)");
  c->add_option("--size", o->size, "of pictures")->capture_default_str();
  c->callback([o, &chosen] { chosen.run = [o, &chosen] { return replay(*o, chosen.json); }; });
}

}  // namespace trocar::app
