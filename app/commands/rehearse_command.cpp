// trocar rehearse: the choices with which a demonstration comes off with an anatomy, for the exercise's file.
#include <fmt/format.h>

#include <trocar/attempt/interrupt.hpp>
#include <trocar/attempt/rehearsal/rehearsal.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>

#include "commands/command.hpp"
#include "commands/number_options.hpp"

namespace trocar::app {
namespace {

struct RehearseChoice {
  std::string exercise;
  std::uint64_t seed = 0;
  attempt::Patience patience;
};

int rehearse(const RehearseChoice& o, bool json) {
  const std::unique_ptr<attempt::Lesson> lesson = attempt::load_lesson(o.exercise, o.seed);
  attempt::catch_interrupts();
  const attempt::Rehearsal r = attempt::rehearse(*lesson, o.patience);
  Json choices = Json::array();
  for (const training::Choice& c : r.choices) choices.push_back({c.at, c.way});
  if (json)
    print({{"exercise", lesson->name},
           {"seed", o.seed},
           {"passed", r.passed},
           {"score", r.score},
           {"lasted_s", r.lasted},
           {"simulated_s", r.seconds},
           {"attempts", r.attempts},
           {"obstacle", r.obstacle},
           {"choices", choices}});
  else if (r.passed)
    fmt::print(
        "score {:.0f} of 100 in {:.0f} s, at attempt {} ({:.0f} s simulated). For \"rehearsed\" in the "
        "exercise's file:\n  {{\"seed\": {}, \"choices\": {}}}\n",
        r.score, r.lasted, r.attempts, r.seconds, o.seed, choices.dump());
  else
    fmt::print(
        "it did not come off in {} attempts ({:.0f} s simulated); the one that came farthest failed after "
        "{:.0f} s: {}\n",
        r.attempts, r.seconds, r.lasted, r.obstacle);
  return r.passed ? core::kDone : core::kGoalNotReached;
}

}  // namespace

void add_rehearse(CLI::App& program, Chosen& chosen) {
  auto o = std::make_shared<RehearseChoice>();
  CLI::App* c = add_command(program, chosen, "rehearse",
                            "Try a demonstration in other ways where it goes wrong, until all of it comes off",
                            "trocar rehearse cholecystectomy/operation --seed 3");
  c->add_option("exercise", o->exercise, "a name that `trocar list` shows, or a path")->required();
  c->add_option("--seed", o->seed, "of the anatomy; 0: as drawn")
      ->capture_default_str()
      ->transform(whole_number(0, kLargestSeed));
  c->add_option("--points", o->patience.points, "that its errors may cost in all")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 100.0));
  c->add_option("--most-seconds", o->patience.seconds, "of simulated time, all attempts together")
      ->capture_default_str()
      ->check(number_above(0, kLongestRun, "s"));
  c->add_flag("--at-first", o->patience.at_first, "a try that fails counts, though its goal may be tried again");
  c->callback([o, &chosen] { chosen.run = [o, &chosen] { return rehearse(*o, chosen.json); }; });
}

}  // namespace trocar::app
