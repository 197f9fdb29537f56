// trocar train: an exercise, done by hand in a window, or by a source of inputs with or without one.
#include <fmt/format.h>

#include <trocar/attempt/attempt_log.hpp>
#include <trocar/attempt/box/box_source.hpp>
#include <trocar/attempt/haptics/haptic_source.hpp>
#include <trocar/attempt/interrupt.hpp>
#include <trocar/attempt/paths.hpp>
#include <trocar/attempt/solver_beside.hpp>
#include <trocar/attempt/sources.hpp>
#include <trocar/attempt/team/message.hpp>
#include <trocar/attempt/tracker/tracked_source.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/log.hpp>
#include <trocar/core/text.hpp>
#include <trocar/devices/haptics/choose_device.hpp>
#include <trocar/pictures/analysis_choice.hpp>
#include <trocar/pictures/headless.hpp>
#include <trocar/reports/report_page.hpp>
#include <trocar/scene/checks/equilibrium_check.hpp>

#include "commands/command.hpp"
#include "commands/number_options.hpp"
#include "commands/team_options.hpp"
#include "rooms/room_beside.hpp"
#include "shell/event_log.hpp"
#include "trainer/window_loop.hpp"

namespace trocar::app {
namespace {

struct TrainChoice {
  std::string exercise, input = "mouse", record, shots, video, report, data, size, stereo = "off", show, analysis,
                        trainee, log, beside, room, map, haptics, haptics_hand, tracker;
  double seconds = 0, data_rate = pictures::kDataRate;
  std::uint64_t seed = 0;
  bool headless = false, familiarisation = false, no_store = false;
  TeamChoice team;
};

constexpr std::uint64_t kLogTimeEvery = 250;  ///< ticks
constexpr std::uint64_t kAftermath = 1500;    ///< ticks that hands lead on when the exercise is done

int exit_code(const Json& result, const std::string& input) {
  if (result.contains("log_failure")) return core::kEnvironment;  // told already
  if (result.contains("failure") || result.contains("interrupted")) return core::kGoalNotReached;
  // A recorded motion knows nothing of the exercise: its goal is to be performed to its end.
  if (input.rfind("motion:", 0) == 0 || result["passed"].is_null()) return core::kDone;
  return result["passed"].get<bool>() ? core::kDone : core::kGoalNotReached;
}

/// The result in a few lines, for people.
void tell(const Json& result) {
  if (result.contains("failure")) {
    fmt::print("{}\n",
               tr("not assessed: the simulation failed after {:.1f} s", result["simulated_seconds"].get<double>()));
  } else if (result["passed"].is_null()) {
    fmt::print("done: {:.1f} s\n", result["simulated_seconds"].get<double>());
  } else {
    const Json& a = result["assessment"];
    const double score = a["score"]["total"].get<double>(), seconds = result["exercise_seconds"].get<double>();
    fmt::print("{}", result["passed"].get<bool>()
                         ? tr("passed: score {:.0f} of 100 in {:.0f} s\n", score, seconds)
                         : tr("not passed: score {:.0f} of 100 in {:.0f} s\n", score, seconds));
    for (const Json& step : a["steps"])
      fmt::print("  [{}] {}\n", step["done"].get<bool>() ? "x" : " ", step["name"].get<std::string>());
    for (const Json& e : a["errors"])
      fmt::print("  error {}: {} (-{:.0f})\n", e["code"].get<std::string>(), e["meaning"].get<std::string>(),
                 e["points"].get<double>());
  }
  for (const char* key : {"recording", "report"})
    if (result.contains(key)) fmt::print("{}: {}\n", key, result[key].get<std::string>());
}

attempt::AttemptPlan plan_of(const TrainChoice& o) {
  attempt::AttemptPlan plan;
  plan.trainee = o.trainee;
  plan.mode = o.familiarisation ? training::AttemptMode::familiarisation : attempt::mode_of_input(o.input);
  plan.input = o.input;
  plan.recording = o.record;
  plan.record = !o.headless;  // a script that wants a recording names it
  return plan;
}

Json train_headless(const TrainChoice& o, const attempt::Lesson& lesson, training::Store* store,
                    pictures::PictureSize size) {
  std::vector<std::unique_ptr<attempt::InputSource>> sources;  // each around the one before
  sources.push_back(attempt::make_input(lesson, o.input, attempt::BoxPace::stepped));
  std::unique_ptr<attempt::HapticHand> haptic;
  if (!o.haptics.empty()) {
    haptic = std::make_unique<attempt::HapticHand>(
        lesson.model, attempt::haptic_hand_of(lesson.model, o.haptics_hand, "--haptics-hand"),
        devices::choose_haptic_device(o.haptics, "--haptics"), attempt::HapticHand::Pace::with_ticks,
        attempt::HapticHand::Feel{});
    sources.push_back(std::make_unique<attempt::HapticSource>(*sources.back(), *haptic));
  }
  if (!o.tracker.empty())
    sources.push_back(
        std::make_unique<attempt::TrackedSource>(*sources.back(), lesson.model, attempt::read_tracker_plan(o.tracker)));
  std::unique_ptr<attempt::TeamHost> team;
  if (!o.team.roles.empty()) {
    team = std::make_unique<attempt::TeamHost>(lesson, team_plan(o.team));
    sources.push_back(std::make_unique<attempt::HostedSource>(*team, *sources.back()));
    core::log::info("the others join with{}", how_to_join(*team, o.team));
  }
  attempt::InputSource& source = *sources.back();
  attempt::Session session(lesson);
  EventLog events(o.log);
  attempt::AttemptLog log(store, session, plan_of(o));
  events.event("attempt", {{"exercise", lesson.name}, {"recording", log.attempt().recording}});
  const pictures::HeadlessOptions what{
      .shots = o.shots,
      .video = o.video,
      .data = {o.data, o.data_rate},
      .size = size,
      .look = {pictures::parse_stereo(o.stereo), pictures::parse_show(o.show), pictures::parse_analysis(o.analysis)},
      .seconds = o.seconds,
      .real_time = team != nullptr || !o.tracker.empty()};
  const bool hands = source.device().has_value();  // they do not come to an end by themselves
  std::uint64_t aftermath = 0;
  const pictures::Leftovers left = pictures::run_headless(session, source, what, [&] {
    for (const attempt::Moment& m : session.moments()) events.moment(lesson.model, m);
    if (session.state().tick % kLogTimeEvery == 0) events.event("time", {{"tick", session.state().tick}});
    if (hands && session.finished()) ++aftermath;
    return aftermath < kAftermath;
  });
  if (team) team->end(attempt::interrupted() ? "the host has ended it" : attempt::message::kFinished);
  const bool aborted = attempt::interrupted() && !(session.monitor() && session.monitor()->finished());
  Json result = session.result(aborted);
  result["input"] = o.input;
  result["slow_motion_share"] = 0.0;
  result.update(source.describe());
  log.end(result, aborted ? training::AttemptState::aborted : training::AttemptState::finished);
  events.event("end", {{"interrupted", aborted}, {"passed", result["passed"]}, {"ticks", result["ticks"]}});
  if (!events.failure().empty()) result["log_failure"] = events.failure();
  result.update(left);
  if (!o.report.empty()) result["report"] = reports::write_report(o.report, result, store, &session);
  return result;
}

WindowOptions window_options(const TrainChoice& o, training::Store* store,
                             std::shared_ptr<const attempt::Lesson> other) {
  WindowOptions w;
  w.exercise = o.exercise;
  w.record = o.record;
  w.seed = o.seed;
  w.trainee = o.trainee;
  w.input = o.input;
  w.log = o.log;
  if (!o.size.empty()) w.size = pictures::parse_size(o.size);
  w.seconds = o.seconds;
  w.familiarisation = o.familiarisation;
  w.store = store;
  w.beside = o.beside;
  w.room = o.room;
  if (!o.map.empty()) w.map = attempt::read_input_map(o.map);
  if (!o.tracker.empty()) w.tracker = attempt::read_tracker_plan(o.tracker);
  if (!o.team.roles.empty()) w.team = team_plan(o.team);
  w.haptics = o.haptics;
  w.haptics_hand = o.haptics_hand;
  w.other_solver = std::move(other);
  return w;
}

/// A device that is not there, a hand that is not there: told before a window opens.
void check_haptics(const TrainChoice& o, const attempt::Lesson* lesson) {
  if (o.haptics.empty() && !o.haptics_hand.empty())
    throw core::BadInput({{{"--haptics-hand", 0, 0}, "expected --haptics with it, got none"}});
  if (o.haptics.empty()) return;
  const std::unique_ptr<devices::HapticDevice> device = devices::choose_haptic_device(o.haptics, "--haptics");
  if (o.headless && !device->is_led())
    throw core::BadInput(
        {{{"--haptics", 0, 0}, tr("expected simulated with --headless, where no time passes, got {}", o.haptics)}});
  if (lesson) static_cast<void>(attempt::haptic_hand_of(lesson->model, o.haptics_hand, "--haptics-hand"));
  device->open();
  device->close();
}

int train(const TrainChoice& o, bool json) {
  const bool hands = o.input == "mouse" || o.input == "gamepad";
  if (o.headless && hands)
    throw core::BadInput(
        {{{"--headless", 0, 0},
          tr("expected --input demo, motion:FILE, replay:FILE or box:PORT with it, got {}", o.input)}});
  if (o.exercise.empty() && (o.headless || !hands))
    throw core::BadInput({{{"train", 0, 0}, "expected an exercise (see trocar list), got none"}});
  // Faults are told before anything is begun.
  if (!o.beside.empty() && (o.headless || o.exercise.empty()))
    throw core::BadInput({{{"--beside", 0, 0},
                           "expected an exercise in a window with it; without one, trocar compare says how far both "
                           "solvers are apart"}});
  if (!o.room.empty() && o.headless)
    throw core::BadInput(
        {{{"--room", 0, 0}, "expected a window with it; trocar room FILE follow RECORDING needs none"}});
  if (!o.room.empty()) load_room(o.room);
  pictures::check_data_rate(o.data_rate);
  static_cast<void>(pictures::parse_stereo(o.stereo)), static_cast<void>(pictures::parse_show(o.show));
  static_cast<void>(pictures::parse_analysis(o.analysis));
  const pictures::PictureSize size = pictures::parse_size(o.size.empty() ? "800x600" : o.size);
  std::unique_ptr<attempt::Lesson> lesson = o.exercise.empty() ? nullptr : attempt::load_lesson(o.exercise, o.seed);
  if (lesson) scene::warn_if_unstable(lesson->model);
  check_haptics(o, lesson.get());
  std::shared_ptr<const attempt::Lesson> other;
  if (!o.beside.empty()) other = attempt::load_beside(o.exercise, o.seed, o.beside, "--beside");
  std::unique_ptr<training::Store> store;
  if (!o.no_store) store = std::make_unique<training::Store>(attempt::data_folder());
  Json result = o.headless ? train_headless(o, *lesson, store.get(), size)
                           : run_window(std::move(lesson), window_options(o, store.get(), std::move(other)));
  if (result.is_null()) return core::kDone;  // the window was closed before anything was begun
  if (!o.report.empty() && !o.headless) result["report"] = reports::write_report(o.report, result, store.get());
  if (json)
    print(result);
  else
    tell(result);
  // Without an exercise named on the command line there is no one goal to reach, but a log to be written all the same.
  if (o.exercise.empty() && !result.contains("log_failure")) return core::kDone;
  return exit_code(result, o.input);
}

void add_input_options(CLI::App& c, TrainChoice& o) {
  const char* devices = tr("Devices and other sources of input");
  c.add_option("--input", o.input,
               tr("mouse | gamepad (hands, by any device) | demo | motion:FILE[#OPERATOR/TRIAL] | replay:FILE | "
                  "box:PORT[#FILE]"))
      ->capture_default_str()
      ->group(devices);
  c.add_option("--map", o.map, tr("in a window: a file that assigns several devices to instruments"))->group(devices);
  c.add_option("--tracker", o.tracker, tr("a file that assigns the tools of a tracker to instruments"))->group(devices);
  c.add_option("--haptics", o.haptics, tr("a haptic device that controls an instrument: {}", devices::kHapticDevices))
      ->group(devices);
  c.add_option("--haptics-hand", o.haptics_hand, tr("the port of that instrument; default: the right hand's"))
      ->group(devices);
}

void add_window_options(CLI::App& c, TrainChoice& o) {
  const char* window = tr("In a window");
  c.add_option("--room", o.room, tr("an operating room beside the exercise, with its arms (see trocar room)"))
      ->group(window);
  c.add_option("--beside", o.beside,
               tr("an organ of the scene: its other solver runs beside, and the analysis shows the difference"))
      ->group(window);
}

void add_headless_options(CLI::App& c, TrainChoice& o) {
  const char* headless = tr("Without a window");
  c.add_flag("--headless", o.headless, tr("no window, as fast as the machine allows"))->group(headless);
  c.add_option("--shots", o.shots, tr("write pictures of key moments to this folder"))->group(headless);
  c.add_option("--video", o.video, tr("write a film to this file (needs ffmpeg)"))->group(headless);
  c.add_option("--stereo", o.stereo, tr(pictures::kStereoHelp))->capture_default_str()->group(headless);
  c.add_option("--show", o.show, tr(pictures::kShowHelp))->group(headless);
  c.add_option("--analysis", o.analysis, tr(pictures::kAnalysisHelp))->group(headless);
  c.add_option("--data", o.data, tr(pictures::kDataHelp))->group(headless);
  c.add_option("--data-rate", o.data_rate, tr("frames per simulated second"))
      ->capture_default_str()
      ->check(number_between(pictures::kLeastDataRate, pictures::kMostDataRate, "frames a second"))
      ->group(headless);
}

void add_record_options(CLI::App& c, TrainChoice& o) {
  const char* recording = tr("Recording and results");
  c.add_option("--record", o.record, tr("write the recording to this file"))->group(recording);
  c.add_option("--report", o.report, tr("write an HTML report to this folder"))->group(recording);
  c.add_option("--log", o.log, tr("write events as JSON lines to this file"))->group(recording);
  c.add_flag("--no-store", o.no_store, tr("keep nothing in the session store"))->group(recording);
}

}  // namespace

void add_train(CLI::App& program, Chosen& chosen) {
  auto options = std::make_shared<TrainChoice>();
  TrainChoice& o = *options;
  CLI::App* c = add_command(program, chosen, "train", tr("Do an exercise, in a window or without one"),
                            "trocar train gynaecology/sterilisation\n"
                            "  trocar train gynaecology/sterilisation --input demo --headless --record a.rec --shots "
                            "shots --json");
  c->add_option("exercise", o.exercise, tr("a name that `trocar list` shows, or a file; default: the start screen"));
  c->add_option("--trainee", o.trainee,
                tr("name of the trainee; default: in a window the last person, otherwise guest"));
  c->add_option("--seed", o.seed, tr("number of a random patient; 0: the standard patient"))
      ->capture_default_str()
      ->transform(whole_number(0, kLargestSeed));
  c->add_flag("--familiarisation", o.familiarisation, tr("familiarise: no score and no verdict"));
  c->add_option("--seconds", o.seconds, tr("stop after this simulated time [s]; default: at the end of the exercise"))
      ->check(number_above(0, kLongestRun, "s"));
  c->add_option("--size", o.size,
                tr("WIDTHxHEIGHT of the window (default: as last time) or of pictures (default: "
                   "800x600)"));
  add_input_options(*c, o);
  add_window_options(*c, o);
  add_headless_options(*c, o);
  add_record_options(*c, o);
  add_team_options(*c, o.team);
  c->callback([options, &chosen] { chosen.run = [options, &chosen] { return train(*options, chosen.json); }; });
}

}  // namespace trocar::app
