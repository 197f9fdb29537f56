// trocar rehearse: the ways in which a demonstration's parts come off with an anatomy, for the exercise's file.
#include <fmt/format.h>

#include <trocar/attempt/rehearsal.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>

#include "commands/command.hpp"
#include "commands/number_options.hpp"

namespace trocar::app {
namespace {

constexpr int kMostWays = 100;

struct RehearseChoice {
  std::string exercise;
  std::uint64_t seed = 0;
  attempt::Patience patience;
};

int rehearse(const RehearseChoice& o, bool json) {
  const std::unique_ptr<attempt::Lesson> lesson = attempt::load_lesson(o.exercise, o.seed);
  const attempt::Rehearsal r = attempt::rehearse(*lesson, o.patience);
  Json ways = Json::array();
  for (const int way : r.ways) ways.push_back(way);
  const Json line = {{"seed", o.seed}, {"ways", ways}};
  if (json) {
    Json all = {{"exercise", lesson->name}, {"seed", o.seed},         {"passed", r.passed},
                {"score", r.score},         {"seconds", r.lasted},    {"simulated_seconds", r.seconds},
                {"tries", r.tries},         {"farthest", r.farthest}, {"ways", ways}};
    print(all);
  } else if (r.passed) {
    fmt::print(
        "score {:.0f} of 100 in {:.0f} s, after {} parts tried ({:.0f} s simulated). For \"rehearsed\" in the "
        "exercise's file:\n  {}\n",
        r.score, r.lasted, r.tries, r.seconds, line.dump());
  } else {
    fmt::print("it did not come off in {} parts tried ({:.0f} s simulated); farthest: {}\n", r.tries, r.seconds,
               r.farthest);
  }
  return r.passed ? core::kDone : core::kGoalNotReached;
}

}  // namespace

void add_rehearse(CLI::App& program, Chosen& chosen) {
  auto o = std::make_shared<RehearseChoice>();
  CLI::App* c =
      add_command(program, chosen, "rehearse", "Try a demonstration's parts in several ways until all comes off",
                  "trocar rehearse cholecystectomy/operation --seed 3");
  c->add_option("exercise", o->exercise, "a name that `trocar list` shows, or a path")->required();
  c->add_option("--seed", o->seed, "of the anatomy; 0: as drawn")
      ->capture_default_str()
      ->transform(whole_number(0, kLargestSeed));
  c->add_option("--ways", o->patience.ways, "in which a part is tried before the one before it is done otherwise")
      ->capture_default_str()
      ->check(CLI::Range(1, kMostWays));
  c->add_option("--failures", o->patience.failures, "of skills in a part before a way is given up")
      ->capture_default_str();
  c->add_option("--points", o->patience.points, "that errors in a part may cost")->capture_default_str();
  c->add_option("--most-seconds", o->patience.seconds, "of simulated time, all tries together")->capture_default_str();
  c->callback([o, &chosen] { chosen.run = [o, &chosen] { return rehearse(*o, chosen.json); }; });
}

}  // namespace trocar::app
