// trocar join: a part in somebody else's attempt, over the network.
#include <fmt/format.h>

#include <trocar/attempt/interrupt.hpp>
#include <trocar/attempt/sources.hpp>
#include <trocar/attempt/team/member.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/text.hpp>
#include <trocar/pictures/headless.hpp>

#include "commands/command.hpp"
#include "commands/team_options.hpp"
#include "trainer/window_loop.hpp"

namespace trocar::app {
namespace {

struct JoinChoice {
  std::string at, role, token, input = "mouse", size, log;
  bool headless = false;
};

Json join_headless(const attempt::Lesson& lesson, const std::shared_ptr<attempt::TeamMember>& member) {
  attempt::Session session(lesson);
  pictures::HeadlessOptions what;
  what.real_time = true;
  static_cast<void>(pictures::run_headless(session, *member, what));
  Json result = session.result(attempt::interrupted());
  result.update(member->describe());
  return result;
}

Json join_window(std::unique_ptr<attempt::Lesson> lesson, const std::shared_ptr<attempt::TeamMember>& member,
                 const JoinChoice& o) {
  WindowOptions w;
  w.exercise = lesson->name;
  w.seed = lesson->seed;
  w.input = o.input;
  w.log = o.log;
  w.member = member;
  if (!o.size.empty()) w.size = pictures::parse_size(o.size);
  Json result = run_window(std::move(lesson), w);
  if (result.is_null()) result = Json::object();
  result.update(member->describe());
  return result;
}

int join(const JoinChoice& o, bool json) {
  const bool hands = o.input == "mouse" || o.input == "gamepad";
  if (!hands && o.input != "demo")
    throw core::BadInput({{{"--input", 0, 0}, tr("expected mouse, gamepad or demo, got {}", o.input)}});
  if (hands && o.headless)
    throw core::BadInput({{{"--headless", 0, 0}, tr("expected --input demo with it, got {}", o.input)}});
  const Place place = parse_place(o.at, "join");
  attempt::catch_interrupts();
  const auto member =
      std::make_shared<attempt::TeamMember>(attempt::MemberPlan{place.address, place.port, o.token, o.role});
  std::unique_ptr<attempt::Lesson> lesson = attempt::load_lesson(member->attempt().exercise, member->attempt().seed);
  member->begin(*lesson);
  if (o.input == "demo") member->follow(lesson->surgeon());
  const Json result = o.headless ? join_headless(*lesson, member) : join_window(std::move(lesson), member, o);
  if (json)
    print(result);
  else
    fmt::print("{}", tr("{}: {}; own motion was in everybody's picture after {:.0f} ms\n", o.role, member->ended(),
                        1000 * member->latency()));
  return member->ended() == attempt::message::kFinished ? core::kDone : core::kGoalNotReached;
}

}  // namespace

void add_join(CLI::App& program, Chosen& chosen) {
  auto o = std::make_shared<JoinChoice>();
  CLI::App* c = add_command(program, chosen, "join", tr("Control the camera or an instrument in another attempt"),
                            "trocar join 192.168.1.20:4711 --role camera --token TOKEN");
  c->add_option("at", o->at, tr("ADDRESS:PORT of the host: `trocar train EXERCISE --team camera` shows it"))
      ->required();
  c->add_option("--role", o->role, tr("camera, assistant, left, right, or a port's name"))->required();
  c->add_option("--token", o->token, tr("the token that the host shows"))->required()->envname(kTokenVariable);
  c->add_option("--input", o->input, tr("mouse | gamepad (hands, by any device) | demo"))->capture_default_str();
  c->add_flag("--headless", o->headless, tr("no window"));
  c->add_option("--size", o->size, tr("WIDTHxHEIGHT of the window; default: as last time"));
  c->add_option("--log", o->log, tr("write events as JSON lines to this file"));
  c->callback([o, &chosen] { chosen.run = [o, &chosen] { return join(*o, chosen.json); }; });
}

}  // namespace trocar::app
