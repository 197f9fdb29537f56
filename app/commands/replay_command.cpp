// trocar replay: a recording in a window (player.hpp), or without one: every state hash compared, pictures and a film
// of any part of it from any camera (replay_headless.hpp).
#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/log.hpp>
#include <trocar/core/text.hpp>
#include <trocar/pictures/analysis_choice.hpp>

#include "commands/command.hpp"
#include "commands/number_options.hpp"
#include "commands/replay_headless.hpp"
#include "player/player.hpp"

namespace trocar::app {
namespace {

struct ReplayChoice {
  std::string size, data, camera = "endoscope", stereo = "off", show, analysis, exercise, log;
  ReplayOptions replay;
  bool headless = false;
};

Json head(const sim::Recording& recording, const ReplayOptions& o) {
  Json out{{"recording", o.file},
           {"exercise", recording.header.exercise},
           {"program_version", recording.header.program_version},
           {"complete", recording.complete},
           {"interrupted", recording.interrupted}};
  if (!recording.damage.empty()) out["damage"] = recording.damage;
  return out;
}

/// What was compared, and what was not.
std::string verified_text(const Json& result) {
  const auto hashes = result["hashes_compared"].get<std::size_t>();
  const auto keyframes = result["keyframes_compared"].get<std::size_t>();
  if (result["score_compared"].get<bool>())
    return tr("verified: {} hashes, {} keyframes; score, errors and steps agree", hashes, keyframes);
  return tr("verified: {} hashes, {} keyframes; score not compared: {}", hashes, keyframes,
            result["score_not_compared"].get<std::string>());
}

int say(const ReplayOptions& o, const Json& result, bool json) {
  const bool failed = o.verify && !result.value("verified", false);
  if (json) {
    print(result);
  } else if (o.verify) {
    fmt::print("{}: {}\n", o.file,
               failed ? result.value("difference", std::string("not verified")) : verified_text(result));
  } else if (result.value("played", std::string()) == "keyframes") {
    fmt::print("{}: {} keyframes\n", o.file, result["keyframes"].get<std::size_t>());
  } else {
    fmt::print("{}: {} ticks\n", o.file, result.value("ticks", std::uint64_t(0)));
  }
  return failed ? core::kGoalNotReached : core::kDone;
}

int replay(ReplayChoice o, bool json) {
  if (!o.size.empty()) o.replay.size = pictures::parse_size(o.size);
  o.replay.camera = pictures::parse_camera(o.camera);
  pictures::check_data_rate(o.replay.data.rate);
  o.replay.data.folder = o.data;
  o.replay.look = {pictures::parse_stereo(o.stereo), pictures::parse_show(o.show),
                   pictures::parse_analysis(o.analysis)};
  const sim::Recording recording = sim::read_recording(o.replay.file);
  if (!recording.damage.empty()) core::log::warn("{}: {}", o.replay.file, recording.damage);
  const std::string& exercise = o.exercise.empty() ? recording.header.exercise : o.exercise;
  const bool window =
      !json && !o.headless && !o.replay.verify && o.replay.shots.empty() && o.replay.video.empty() && o.data.empty();
  if (window) {
    PlayerOptions player;
    player.file = o.replay.file;
    player.exercise = exercise;
    player.log = o.log;
    player.eyes = o.replay.look.eyes;
    if (!o.size.empty()) player.size = o.replay.size;
    run_player(recording, player);
    return core::kDone;
  }
  const std::unique_ptr<attempt::Lesson> lesson = attempt::load_lesson(exercise, recording.header.seed);
  Json result = head(recording, o.replay);
  result.update(replay_headless(*lesson, recording, o.replay));
  return say(o.replay, result, json);
}

}  // namespace

void add_replay(CLI::App& program, Chosen& chosen) {
  auto o = std::make_shared<ReplayChoice>();
  const char* film = tr("Pictures, film and data");
  CLI::App* c =
      add_command(program, chosen, "replay", tr("Play a recording in a window, film it, or verify it"),
                  "trocar replay a.rec\n"
                  "  trocar replay a.rec --verify\n"
                  "  trocar replay a.rec --shots pictures --camera front\n"
                  "  trocar replay a.rec --video a.mp4 --camera free:120,30,250 --from 12 --to 20 --slow 0.25");
  c->add_option("recording", o->replay.file, tr("a recording (train --record)"))->required();
  c->add_flag("--verify", o->replay.verify,
              tr("compare model, states and keyframes, and judge the attempt again; exit 1 where something differs or "
                 "the recording has no end"));
  c->add_option("--exercise", o->exercise, tr("the recording's exercise, where its file has moved"));
  c->add_flag("--headless", o->headless, tr("no window"));
  c->add_option("--size", o->size, tr("WIDTHxHEIGHT of pictures (default: 800x600) or of the window"));
  c->add_option("--log", o->log, tr("write events of the window as JSON lines to this file"));
  c->add_option("--shots", o->replay.shots, tr("write pictures to this folder"))->group(film);
  c->add_option("--video", o->replay.video, tr("write a film, H.264 (needs ffmpeg)"))->group(film);
  c->add_option("--camera", o->camera,
                tr("endoscope | front | side | above | surgeon | free:YAW,PITCH,DISTANCE [deg, deg, mm]"))
      ->capture_default_str()
      ->group(film);
  c->add_option("--stereo", o->stereo, tr(pictures::kStereoHelp))->capture_default_str()->group(film);
  c->add_option("--show", o->show, tr(pictures::kShowHelp))->group(film);
  c->add_option("--analysis", o->analysis, tr(pictures::kAnalysisHelp))->group(film);
  c->add_option("--from", o->replay.from, tr("first moment of pictures and film [s]; default: the start"))
      ->check(number_between(0, kLongestRecording, "s"))
      ->group(film);
  c->add_option("--to", o->replay.to, tr("last moment [s]; default: the end"))
      ->check(number_between(0, kLongestRecording, "s"))
      ->group(film);
  c->add_option("--slow", o->replay.speed, tr("speed of the film: 0.25 takes four times as long; default: 1"))
      ->check(number_between(pictures::kSlowest, pictures::kFastest, ""))
      ->group(film);
  c->add_option("--data", o->data, tr(pictures::kDataHelp))->group(film);
  c->add_option("--data-rate", o->replay.data.rate, tr("frames per simulated second"))
      ->capture_default_str()
      ->check(number_between(pictures::kLeastDataRate, pictures::kMostDataRate, "frames a second"))
      ->group(film);
  c->callback([o, &chosen] { chosen.run = [o, &chosen] { return replay(*o, chosen.json); }; });
}

}  // namespace trocar::app
