// trocar rehearse: the choices with which a demonstration comes off with an anatomy, for the exercise's file.
#include <fmt/format.h>

#include <trocar/attempt/interrupt.hpp>
#include <trocar/attempt/rehearsal/rehearsal.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/text.hpp>

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
  for (const training::Choice& c : r.choices) choices.push_back({c.at, c.perturbation});
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
    fmt::print("{}", tr("score {:.0f} of 100 in {:.0f} s, at attempt {} ({:.0f} s simulated). For \"rehearsed\" in the "
                        "exercise's file:\n  {{\"seed\": {}, \"choices\": {}}}\n",
                        r.score, r.lasted, r.attempts, r.seconds, o.seed, choices.dump()));
  else
    fmt::print("{}\n",
               tr("The demonstration failed in all {} attempts ({:.0f} s simulated). The longest one failed after "
                  "{:.0f} s: {}",
                  r.attempts, r.seconds, r.lasted, r.obstacle));
  return r.passed ? core::kDone : core::kGoalNotReached;
}

}  // namespace

void add_rehearse(CLI::App& program, Chosen& chosen) {
  auto o = std::make_shared<RehearseChoice>();
  CLI::App* c =
      add_command(program, chosen, "rehearse", tr("Search for a perturbation with which the demonstration succeeds"),
                  "trocar rehearse cholecystectomy/operation --seed 3");
  c->add_option("exercise", o->exercise, tr("a name that `trocar list` shows, or a file"))->required();
  c->add_option("--seed", o->seed, tr("number of a random patient; 0: the standard patient"))
      ->capture_default_str()
      ->transform(whole_number(0, std::int64_t(training::kLargestRehearsedSeed)));
  c->add_option("--points", o->patience.points, tr("most points that errors may cost in all"))
      ->capture_default_str()
      ->check(number_between(0, 100, "points"));
  c->add_option("--most-seconds", o->patience.seconds, tr("most simulated time of all attempts together [s]"))
      ->capture_default_str()
      ->check(number_above(0, kLongestRun, "s"));
  c->add_flag("--at-first", o->patience.at_first, tr("a failed try counts as a failure, even if it may be repeated"));
  c->callback([o, &chosen] { chosen.run = [o, &chosen] { return rehearse(*o, chosen.json); }; });
}

}  // namespace trocar::app
