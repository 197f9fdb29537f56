// trocar tracker: a look at what a tracker's server sends.
#include <thread>

#include <fmt/format.h>

#include <trocar/attempt/interrupt.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/devices/steady_now.hpp>
#include <trocar/devices/tracker/tracker_thread.hpp>

#include "commands/command.hpp"
#include "commands/number_options.hpp"
#include "commands/team_options.hpp"

namespace trocar::app {
namespace {

using devices::TrackerThread;

struct TrackerChoice {
  std::string place;
  double seconds = 0;
};

std::int64_t age(const TrackerThread::Heard<devices::TrackedPose>& tool) { return devices::steady_now() - tool.at; }
bool is_seen(const TrackerThread::Heard<devices::TrackedPose>& tool) {
  return tool.times > 0 && tool.unseen.empty() && age(tool) < devices::kUnseen;
}

Json tool_json(const TrackerThread::Heard<devices::TrackedPose>& tool) {
  Json out{{"seen", is_seen(tool)}, {"times", tool.times}};
  if (!tool.unseen.empty()) out["status"] = tool.unseen;
  if (tool.times == 0) return out;
  const Vec3d at = tool.what.place;
  out["at_mm"] = {1000 * at.x, 1000 * at.y, 1000 * at.z};
  out["age_ms"] = 1e-6 * double(age(tool));
  return out;
}

Json seen_json(const TrackerThread& tracker) {
  Json tools = Json::object(), sensors = Json::object();
  for (const auto& heard : tracker.poses()) tools[heard.what.name] = tool_json(heard);
  for (const auto& heard : tracker.all_values()) sensors[heard.what.name] = heard.what.values;
  const TrackerThread::Status status = tracker.status();
  return {{"connected", status.connected},
          {"messages", status.messages},
          {"damaged", status.damaged},
          {"tools", tools},
          {"sensors", sensors}};
}

void show_tool(const TrackerThread::Heard<devices::TrackedPose>& tool) {
  const std::string& name = tool.what.name;
  const double ms = 1e-6 * double(age(tool));
  if (is_seen(tool)) {
    fmt::print("{}", tr("  {:20} {:9.1f} {:9.1f} {:9.1f} mm  {:5.0f} ms old  {} times\n", name,
                        1000 * tool.what.place.x, 1000 * tool.what.place.y, 1000 * tool.what.place.z, ms, tool.times));
  } else if (tool.times == 0) {
    fmt::print("{}", tr("  {:20} not seen ({})\n", name, tool.unseen));
  } else if (tool.unseen.empty()) {
    fmt::print("{}", tr("  {:20} not seen for {:.1f} s\n", name, 1e-3 * ms));
  } else {
    fmt::print("{}", tr("  {:20} not seen for {:.1f} s ({})\n", name, 1e-3 * ms, tool.unseen));
  }
}

void show_seen(const TrackerThread& tracker) {
  const TrackerThread::Status status = tracker.status();
  fmt::print("{}", status.connected ? tr("connected  {} messages, {} damaged\n", status.messages, status.damaged)
                                    : tr("GONE  {} messages, {} damaged\n", status.messages, status.damaged));
  for (const auto& heard : tracker.poses()) show_tool(heard);
  for (const auto& heard : tracker.all_values()) {
    fmt::print("  {:20}", heard.what.name);
    for (const double value : heard.what.values) fmt::print(" {:9.3f}", value);
    fmt::print("\n");
  }
}

int monitor_tracker(const TrackerChoice& o, bool json) {
  const Place place = parse_place(o.place, "tracker");
  attempt::catch_interrupts();
  const TrackerThread tracker(place.address, place.port);
  const std::int64_t end = o.seconds > 0 ? devices::steady_now() + std::int64_t(1e9 * o.seconds) : INT64_MAX;
  while (!attempt::interrupted() && devices::steady_now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(json ? 100 : 1000));
    if (json)
      fmt::print("{}\n", seen_json(tracker).dump());
    else
      show_seen(tracker);
    if (std::fflush(stdout) != 0) break;  // nobody reads any more
  }
  if (tracker.poses().empty() && tracker.all_values().empty())
    throw core::EnvironmentLacks(
        tr("nothing that can be read came from {}: does it send TRANSFORM, POSITION, TDATA or QTDATA (OpenIGTLink)?",
           o.place));
  return core::kDone;
}

}  // namespace

void add_tracker(CLI::App& program, Chosen& chosen) {
  CLI::App* tracker = program.add_subcommand("tracker", tr("Show what a tracker's server (OpenIGTLink) sends"));
  tracker->require_subcommand(1);
  tracker->footer("Example:\n  trocar tracker monitor 127.0.0.1:18944");
  auto o = std::make_shared<TrackerChoice>();
  CLI::App* c =
      add_command(*tracker, chosen, "monitor", tr("Show names, positions and ages of tools, and values of sensors"),
                  "trocar tracker monitor 127.0.0.1:18944");
  c->add_option("place", o->place, tr("ADDRESS:PORT of the server"))->required();
  c->add_option("--seconds", o->seconds, tr("stop after this time [s]"))->check(number_above(0, kLongestRun, "s"));
  c->callback([o, &chosen] { chosen.run = [o, &chosen] { return monitor_tracker(*o, chosen.json); }; });
}

}  // namespace trocar::app
