// trocar box: a box of software at a port, a look at what a box sends, and its calibration.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <thread>

#include <fmt/format.h>
#include <unistd.h>

#include <trocar/attempt/box/box_file.hpp>
#include <trocar/attempt/box/box_playback.hpp>
#include <trocar/attempt/box/soft_ports.hpp>
#include <trocar/attempt/interrupt.hpp>
#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/log.hpp>
#include <trocar/core/text.hpp>
#include <trocar/devices/box/box_thread.hpp>
#include <trocar/devices/box/serving.hpp>
#include <trocar/sim/recording/recording.hpp>

#include "box/calibration_window.hpp"
#include "commands/command.hpp"
#include "commands/number_options.hpp"

namespace trocar::app {
namespace {

using devices::BoxTime;

const char* axis_word(int actor, int axis) {
  const bool post = devices::BoxActor(actor) == devices::BoxActor::scope && axis == int(devices::BoxAxis::handle);
  return post ? "post" : devices::kBoxAxisNames[std::size_t(axis)];
}

/// An axis in the unit that people read.
std::string value_text(int actor, int axis, double value) {
  if (devices::BoxAxis(axis) == devices::BoxAxis::depth) return fmt::format("{:7.1f} mm", 1000 * value);
  if (devices::BoxAxis(axis) == devices::BoxAxis::handle && devices::BoxActor(actor) != devices::BoxActor::scope)
    return fmt::format("{:7.2f}   ", value);
  return fmt::format("{:7.2f} deg", value * 57.29577951308232);
}

// --- simulate ---

/// What the hands do and the box cannot say.
void warn_of_reach(const devices::BoxAngles& beyond) {
  for (int actor = 0; actor < devices::kBoxActors; ++actor)
    for (int axis = 0; axis < devices::kBoxAxes; ++axis)
      if (const double by = beyond[std::size_t(actor)][std::size_t(axis)]; by > 0)
        core::log::warn("{} {}: these hands go beyond what its channel reaches, by{}",
                        devices::kBoxActorNames[std::size_t(actor)], axis_word(actor, axis),
                        value_text(actor, axis, by));
}

struct SimulateChoice {
  std::string port, exercise, motion, replay, wiring, clock = "real";
  std::uint64_t seed = 0;
  bool raw = false, framed = false, wave = false;
  double hz = 0, noise = 0, drop = 0, corrupt = 0, latency_ms = 0, lead_in = 1, seconds = 0;
  double port_drift_mm = 0, port_stiffness = 0;
  int baud = 0;
};

devices::BoxWiring wiring_of(const std::string& file, bool raw, bool framed, int baud) {
  devices::BoxWiring wiring = attempt::load_wiring(file);
  if (raw || framed) wiring.raw = raw;
  if (baud != 0) wiring.baud = baud;
  return wiring;
}

std::vector<sim::Input> inputs_of(const SimulateChoice& o, const attempt::Lesson& lesson) {
  if (!o.motion.empty()) return attempt::inputs_of_motion(lesson, o.motion);
  if (!o.replay.empty()) {
    std::vector<sim::Input> inputs = sim::read_recording(o.replay).inputs;
    if (inputs.empty()) throw core::BadInput({{{o.replay, 0, 0}, "expected a recording with at least one tick"}});
    return inputs;
  }
  if (o.wave || !lesson.exercise) return attempt::waving_inputs(lesson.model);
  core::log::info("the demonstration is performed first");
  double next = 0;
  return attempt::inputs_of_demonstration(lesson, [&next](double seconds) {
    if (seconds >= next) core::log::info("{:.0f} s performed", seconds), next += 20;
    return !attempt::interrupted();
  });
}

/// What the reader of the software box does, where it matters to its hands.
void tell_of_reader(devices::PortReader before, devices::PortReader now, double seconds) {
  using devices::PortReader;
  if (now == PortReader::stopped)
    core::log::warn("{}", tr("the program that reads the box has stopped asking: its hands wait at {:.1f} s", seconds));
  else if (now == PortReader::asks && before == PortReader::stopped)
    core::log::info("{}", tr("the program asks again: the hands resume at {:.1f} s", seconds));
  else if (now == PortReader::none)
    core::log::info("{}", tr("the port was closed at {:.1f} s: the hands restart with the next program", seconds));
}

int simulate(const SimulateChoice& o, bool json) {
  const devices::BoxWiring wiring = wiring_of(o.wiring, o.raw, o.framed, o.baud);
  if (o.exercise.empty() && (!o.motion.empty() || !o.replay.empty() || o.wave))
    throw core::BadInput({{{"--exercise", 0, 0}, "expected the exercise in whose scene these hands move, got none"}});
  const attempt::SoftPorts ports{1000 * o.port_stiffness, o.port_drift_mm / 1000, o.seed + 1};
  if (o.exercise.empty() && ports.moves())
    throw core::BadInput({{{"--exercise", 0, 0}, "expected the exercise whose ports give or drift, got none"}});
  attempt::catch_interrupts();
  devices::SoftwareBoxSettings settings;
  settings.raw = wiring.raw;
  settings.baud = wiring.baud;
  settings.stream_rate = o.hz;
  settings.latency = o.latency_ms / 1000;
  settings.noise = o.noise;
  settings.drop = o.drop;
  settings.corrupt = o.corrupt;
  if (o.clock == "requests") settings.per_request = 1 / wiring.rate;
  std::unique_ptr<attempt::Lesson> lesson;
  std::unique_ptr<attempt::BoxPlayback> playback;
  devices::SoftwareBox::Motion motion = [&wiring](double seconds) { return attempt::waving_block(wiring, seconds); };
  if (!o.exercise.empty()) {
    lesson = attempt::load_lesson(o.exercise, o.seed);
    playback = std::make_unique<attempt::BoxPlayback>(
        lesson->model, wiring, attempt::measured_through(lesson->model, ports, inputs_of(o, *lesson)), o.lead_in);
    warn_of_reach(playback->beyond());
    motion = [&playback](double seconds) { return playback->at(seconds); };
  }
  devices::SoftwareBox box(settings, std::move(motion));
  devices::PseudoTerminal terminal(o.port);
  fmt::print(json ? stderr : stdout, "{}",
             wiring.raw
                 ? tr("box at {} ({}), raw blocks at {} Bd; Ctrl-C ends it\n", o.port, terminal.name(), wiring.baud)
                 : tr("box at {} ({}), frames at {} Bd; Ctrl-C ends it\n", o.port, terminal.name(), wiring.baud));
  std::fflush(json ? stderr : stdout);
  const BoxTime end = o.seconds > 0 ? devices::box_now() + devices::box_time(o.seconds) : INT64_MAX;
  devices::PortReader reader = devices::PortReader::none;
  devices::serve(
      box, terminal, [end] { return attempt::interrupted() || devices::box_now() >= end; },
      [&](devices::PortReader now) {
        tell_of_reader(reader, now, box.seconds());
        reader = now;
      });
  if (json)
    print({{"port", o.port}, {"sent", box.sent()}, {"dropped", box.dropped()}});
  else
    fmt::print("{}", tr("{} blocks sent, {} dropped\n", box.sent(), box.dropped()));
  return core::kDone;
}

// --- monitor ---

struct MonitorChoice {
  std::string port, wiring;
  bool raw = false, framed = false, all = false;
  int baud = 0;
  double seconds = 0, hz = 0;
};

std::string line_text(const devices::BoxStatus& s, double age_ms) {
  return tr(
      "{}  {:5.1f} blocks/s  {} blocks  {} missed ({:.2f} %)  {} bad  round trip {:.1f} ms ({:.1f} at most; since the "
      "start 99.9 % within {:.1f}, longest {:.1f})  newest {:.0f} ms old",
      s.open ? "open " : "CLOSED", s.rate, s.counts.blocks, s.counts.missed, 100 * s.counts.missed_share(),
      s.counts.bad, 1000 * devices::box_seconds(s.counts.round_trip), 1000 * devices::box_seconds(s.longest_trip),
      1000 * s.trip_p999, 1000 * s.trip_most, age_ms);
}

std::string table_text(const devices::BoxPose& pose, const devices::BoxWiring& wiring) {
  std::string text;
  for (int axis = 0; axis < devices::kBoxAxes; ++axis) {
    for (int actor = 0; actor < devices::kBoxActors; ++actor) {
      const devices::WiredAxis& wired = wiring.axis(devices::BoxActor(actor), devices::BoxAxis(axis));
      if (wired.channel < 0) continue;
      text += fmt::format(" {:>6} {:<6} {:4} {} |", devices::kBoxActorNames[std::size_t(actor)], axis_word(actor, axis),
                          pose.block.codes[std::size_t(wired.channel)],
                          value_text(actor, axis, pose.axes[std::size_t(actor)][std::size_t(axis)]));
    }
    text += '\n';
  }
  text += fmt::format("channels");
  for (std::size_t i = 0; i < devices::kBoxChannels; ++i)
    text += fmt::format("{}{:5}", i % 16 == 0 ? "\n" : "", pose.block.codes[i]);
  text += tr("\nbits {:032b}  pedals:", pose.block.digital);
  for (std::size_t p = 0; p < devices::kBoxPedals; ++p)
    if ((pose.pedals >> p & 1) != 0) text += fmt::format(" {}", devices::kBoxPedalNames[p]);
  return text + '\n';
}

Json pose_json(const devices::BoxPose& pose) {
  Json all = Json::object();
  for (int actor = 0; actor < devices::kBoxActors; ++actor) {
    Json one = Json::object();
    for (int axis = 0; axis < devices::kBoxAxes; ++axis)
      if (pose.has(devices::BoxActor(actor), devices::BoxAxis(axis)))
        one[axis_word(actor, axis)] = pose.of(devices::BoxActor(actor), devices::BoxAxis(axis));
    if (!one.empty()) all[devices::kBoxActorNames[std::size_t(actor)]] = one;
  }
  return all;
}

Json status_json(const devices::BoxStatus& s, double age_ms) {
  return {{"open", s.open},
          {"rate_hz", s.rate},
          {"blocks", s.counts.blocks},
          {"missed", s.counts.missed},
          {"bad", s.counts.bad},
          {"round_trip_ms", 1000 * devices::box_seconds(s.counts.round_trip)},
          {"round_trip_most_ms", 1000 * devices::box_seconds(s.longest_trip)},
          {"round_trip_p999_ms", 1000 * s.trip_p999},
          {"round_trip_longest_ms", 1000 * s.trip_most},
          {"age_ms", age_ms}};
}

int monitor(const MonitorChoice& o, bool json) {
  devices::BoxWiring wiring = wiring_of(o.wiring, o.raw, o.framed, o.baud);
  const devices::ChannelMask mask = o.all ? devices::kAllBoxChannels : wiring.mask();
  const std::size_t bytes = wiring.raw ? devices::kRawBlockBytes : devices::data_size(mask);
  wiring.rate = std::min(o.hz > 0 ? o.hz : wiring.rate, devices::most_blocks(bytes, wiring.baud));
  attempt::catch_interrupts();
  devices::BoxThread box(o.port, wiring, mask);
  const bool screen = !json && isatty(STDOUT_FILENO) != 0;
  const auto pause = std::chrono::milliseconds(json || screen ? 100 : 1000);
  const BoxTime end = o.seconds > 0 ? devices::box_now() + devices::box_time(o.seconds) : INT64_MAX;
  devices::BoxPose pose;
  if (screen) fmt::print("\033[2J");
  while (!attempt::interrupted() && devices::box_now() < end) {
    std::this_thread::sleep_for(pause);
    box.take(pose);
    const devices::BoxStatus status = box.status();
    const double age = pose.number > 0 ? 1000 * devices::box_seconds(devices::box_now() - pose.acquired) : 0;
    if (json) {
      Json line = status_json(status, age);
      line["codes"] = pose.block.codes;
      line["digital"] = pose.block.digital;
      line["pedals"] = pose.pedals;
      line["hands"] = pose_json(pose);
      fmt::print("{}\n", line.dump());
    } else {
      fmt::print("{}{}\n{}", screen ? "\033[H\033[J" : "", line_text(status, age),
                 pose.number > 0 ? table_text(pose, wiring) : "");
    }
    if (std::fflush(stdout) != 0) break;  // nobody reads any more
  }
  if (pose.number == 0)
    throw core::EnvironmentLacks(
        tr("nothing came from {}: is the box switched on? Try --raw or --framed, and another --baud (now {} at {} Bd)",
           o.port, wiring.raw ? "raw" : "framed", wiring.baud));
  return core::kDone;
}

void add_simulate(CLI::App& box, Chosen& chosen) {
  auto o = std::make_shared<SimulateChoice>();
  CLI::App* c = add_command(box, chosen, "simulate", tr("Simulate an instrument box at a pseudo-terminal"),
                            "trocar box simulate /tmp/box --exercise gynaecology/sterilisation");
  c->add_option("port", o->port, tr("name of the link to the pseudo-terminal"))->required();
  c->add_option(
      "--exercise", o->exercise,
      tr("its hands repeat this exercise's demonstration, computed first; default: every channel moves slowly"));
  CLI::Option* motion =
      c->add_option("--motion", o->motion, tr("its hands repeat FILE[#OPERATOR/TRIAL] in the exercise's scene"));
  CLI::Option* replay = c->add_option("--replay", o->replay, tr("its hands repeat this recording"));
  CLI::Option* wave = c->add_flag("--wave", o->wave, tr("its hands move slowly around their start positions"));
  motion->excludes(replay)->excludes(wave);
  replay->excludes(wave);
  c->add_option("--seed", o->seed, tr("number of a random patient; 0: the standard patient"))
      ->capture_default_str()
      ->transform(whole_number(0, kLargestSeed));
  c->add_option("--wiring", o->wiring,
                tr("the box's file; default: box.json in the data folder, else the built-in wiring"));
  CLI::Option* raw = c->add_flag("--raw", o->raw, tr("blocks of 76 bytes without frames"));
  c->add_flag("--framed", o->framed, tr("frames with checksums"))->excludes(raw);
  c->add_option("--baud", o->baud, tr("speed of the line [baud]; default: the wiring's"))
      ->check(CLI::Range(300, 4'000'000));
  c->add_option("--hz", o->hz, tr("blocks a second that it sends by itself; default: only on request"))
      ->check(number_between(0, 5000, "blocks a second"));
  c->add_option("--noise", o->noise, tr("noise of every channel, standard deviation [codes]"))
      ->check(number_between(0, 1000, "codes"));
  c->add_option("--drop", o->drop, tr("share of blocks that are lost"))->check(number_between(0, 1, ""));
  c->add_option("--corrupt", o->corrupt, tr("share of bytes that are changed"))->check(number_between(0, 1, ""));
  c->add_option("--latency", o->latency_ms, tr("delay of the line [ms]"))->check(number_between(0, 1000, "ms"));
  c->add_option("--port-drift", o->port_drift_mm, tr("drift of its rubber ports [mm]; default: none"))
      ->check(number_between(0, 20, "mm"));
  c->add_option("--port-stiffness", o->port_stiffness, tr("stiffness of its rubber ports [N/mm]; default: rigid"))
      ->check(number_between(0.1, 1000, "N/mm"));
  c->add_option("--clock", o->clock, tr("real: its hands move in real time | requests: one period for each request"))
      ->capture_default_str()
      ->check(CLI::IsMember({"real", "requests"}));
  c->add_option("--lead-in", o->lead_in, tr("time before its hands move [s]"))
      ->capture_default_str()
      ->check(number_between(0, 60, "s"));
  c->add_option("--seconds", o->seconds, tr("stop after this time [s]"))->check(number_above(0, kLongestRun, "s"));
  c->callback([o, &chosen] { chosen.run = [o, &chosen] { return simulate(*o, chosen.json); }; });
}

void add_monitor(CLI::App& box, Chosen& chosen) {
  auto o = std::make_shared<MonitorChoice>();
  CLI::App* c = add_command(box, chosen, "monitor", tr("Show what a box sends: channels, rate, losses, latency"),
                            "trocar box monitor /dev/ttyUSB0");
  c->add_option("port", o->port, tr("a serial port"))->required();
  c->add_option("--wiring", o->wiring,
                tr("the box's file; default: box.json in the data folder, else the built-in wiring"));
  CLI::Option* raw = c->add_flag("--raw", o->raw, tr("blocks of 76 bytes without frames"));
  c->add_flag("--framed", o->framed, tr("frames with checksums"))->excludes(raw);
  c->add_option("--baud", o->baud, tr("speed of the line [baud]; default: the wiring's"))
      ->check(CLI::Range(300, 4'000'000));
  c->add_flag("--all", o->all, tr("show all 48 channels, not only those that are wired"));
  c->add_option("--hz", o->hz, tr("blocks a second that are requested; default: the wiring's"))
      ->check(number_between(attempt::kLeastBoxRate, attempt::kMostBoxRate, "blocks a second"));
  c->add_option("--seconds", o->seconds, tr("stop after this time [s]"))->check(number_above(0, kLongestRun, "s"));
  c->callback([o, &chosen] { chosen.run = [o, &chosen] { return monitor(*o, chosen.json); }; });
}

void add_file(CLI::App& box, Chosen& chosen) {
  auto file = std::make_shared<std::string>();
  CLI::App* c = add_command(box, chosen, "file", tr("Print the wiring and calibration in use as a file"),
                            "trocar box file > ~/.local/share/trocar/box.json");
  c->add_option("--wiring", *file, tr("a file that is checked and printed; default: the one in use"));
  c->callback([file, &chosen] {
    chosen.run = [file] {
      fmt::print("{}", attempt::box_file_text(attempt::load_wiring(*file)));
      return int(core::kDone);
    };
  });
}

void add_calibrate(CLI::App& box, Chosen& chosen) {
  struct CalibrateChoice {
    std::string port, wiring, log;
    bool raw = false, framed = false;
    int baud = 0;
    std::filesystem::path output;  // empty: box.json in the data folder
  };
  auto o = std::make_shared<CalibrateChoice>();
  CLI::App* c = add_command(box, chosen, "calibrate", tr("Calibrate a box in a window, and write its file"),
                            "trocar box calibrate /dev/ttyUSB0");
  c->add_option("port", o->port, tr("a serial port"))->required();
  c->add_option("--wiring", o->wiring,
                tr("a file whose line and filter are kept; default: box.json in the data folder, else built-in"));
  CLI::Option* raw = c->add_flag("--raw", o->raw, tr("blocks of 76 bytes without frames; default: detected"));
  c->add_flag("--framed", o->framed, tr("frames with checksums"))->excludes(raw);
  c->add_option("--baud", o->baud, tr("speed of the line [baud]; default: detected"))
      ->check(CLI::Range(300, 4'000'000));
  c->add_option("--output", o->output, tr("the file that is written; default: box.json in the data folder"));
  c->add_option("--log", o->log, tr("write events of the window as JSON lines to this file"));
  c->callback([o, &chosen] {
    chosen.run = [o, &chosen] {
      if (o->output.empty()) o->output = attempt::data_folder() / "box.json";
      const bool settled = o->raw || o->framed || o->baud != 0;
      const bool written =
          calibrate_in_window({o->port, wiring_of(o->wiring, o->raw, o->framed, o->baud), settled, o->output, o->log});
      if (chosen.json) print({{"written", written}, {"file", o->output.generic_string()}});
      return int(core::kDone);
    };
  });
}

}  // namespace

void add_box(CLI::App& program, Chosen& chosen) {
  CLI::App* box = program.add_subcommand("box", tr("Simulate, show or calibrate an instrument box at a serial port"));
  box->require_subcommand(1);
  box->footer("Example:\n  trocar box simulate /tmp/box\n  trocar box monitor /tmp/box");
  add_simulate(*box, chosen);
  add_monitor(*box, chosen);
  add_calibrate(*box, chosen);
  add_file(*box, chosen);
}

}  // namespace trocar::app
