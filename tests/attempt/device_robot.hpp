// A robot that does an exercise with a device as a person does. The demonstration says what is wanted in each moment:
// poses and grips of both hands, pedals, the camera. Fingers (fingers.hpp) turn the difference from where everything is
// seen into what a gamepad, or mouse and keyboard report, and that goes through the code that the window uses
// (HandPilot, SmoothInput). What it sees and what it wants is 0.15 s old; of what its hands have done since it knows
// nine tenths. The demonstration waits while a hand is far behind.
//
//   DeviceRobot<PadFingers> robot(lesson, {0.002});
//   while (robot.next(session.state(), input)) robot.after(session.state(), session.advance(input));
//   robot.account()
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <trocar/attempt/hand_names.hpp>
#include <trocar/attempt/hand_pilot.hpp>
#include <trocar/attempt/inputs/device_parts.hpp>
#include <trocar/attempt/lesson.hpp>
#include <trocar/attempt/session.hpp>
#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/expert/performer.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/observe/stitches.hpp>

#include "fingers.hpp"

namespace trocar::attempt::robots {

/// Ticks by what was done in them.
struct RobotAccount {
  std::uint64_t ticks = 0;
  std::uint64_t left = 0, right = 0, both = 0;  ///< that tip was faster than 1 mm/s; both were
  std::uint64_t looking = 0, choosing = 0;      ///< the endoscope was led; the rack was open
  std::uint64_t waiting = 0;                    ///< the demonstration waited for the hands
  int exchanges = 0, looks = 0;

  /// [%]
  double share(std::uint64_t part) const { return ticks > 0 ? 100.0 * double(part) / double(ticks) : 0; }
};

/// Two more people at the same machine, each with a gamepad of their own: one leads the endoscope, one the third
/// instrument.
class Others {
 public:
  explicit Others(const sim::Model& model)
      : m_parts(read_input_map_text(R"({"format": 1, "parts": [{"role": "camera", "device": "gamepad 1"},
                                       {"role": "assistant", "device": "gamepad 2"}]})",
                                    "three_pads.json"),
                model),
        m_pads(2) {
    for (devices::DeviceReading& pad : m_pads) pad.is_pad = true;
    m_parts.take_up(m_pads);
  }
  static constexpr int kHand = 2;  ///< the assistant's
  const sim::Input& lead(const sim::Input& operators, const ScopeWish& scope, const HandWish& hand,
                         const sim::State& state) {
    m_pads[0].pad = m_camera.play({}, scope);
    m_pads[1].pad = m_tool.play({}, hand);
    return m_parts.lead(operators, m_pads, float(kPicture), state);
  }

 private:
  DeviceParts m_parts;
  std::vector<devices::DeviceReading> m_pads;
  CameraFingers m_camera;
  OneToolFingers m_tool;
};

template <class Fingers>
class DeviceRobot {
 public:
  /// @param sway  so far the left hand draws what it holds, and eases it, while the right one works [m]
  /// @param alone  false: others lead the endoscope and the third instrument
  DeviceRobot(const Lesson& lesson, double sway, bool alone = true)
      : m_model(lesson.model), m_pilot(lesson.model), m_smooth(lesson.model.start), m_sway(sway) {
    m_pilot.lead_both(true);
    m_side = m_pilot.both().pair;
    m_led.assign(m_side.begin(), m_side.end());
    if (!alone) m_others = std::make_unique<Others>(m_model), m_led.push_back(Others::kHand);
    m_brain = std::make_unique<training::Performer>(
        m_model, training::read_demonstration(*lesson.exercise, m_model, lesson.seed));
    m_commanded = m_wanted = m_model.start;
  }

  bool next(const sim::State& state, sim::Input& input) {
    if (m_brain->done() && ++m_after > kAfter) return false;
    think(state);
    if (m_menu == Menu::closed && (works(state) || !eased())) m_swayed += sim::kTick;
    remember(state);
    if (double(state.tick) * sim::kTick >= m_next_picture) {
      m_next_picture += kPicture;
      picture(state);
    }
    input = m_smooth.step(m_commanded);
    return true;
  }
  void after(const sim::State& state, const sim::StepReport& report) {
    m_brain->after(m_model, state, report);
    count(state);
  }

  const RobotAccount& account() const { return m_account; }
  const training::Performer& brain() const { return *m_brain; }
  std::string now(const sim::State& state) const {
    char text[400];
    const Seen& seen = m_seen[state.tick % kDelay];
    int n = std::snprintf(text, sizeof text, "%.1f s %s%s%s", double(state.tick) * sim::kTick, m_brain->doing(),
                          m_looks ? ", looks" : "", m_menu != Menu::closed ? ", chooses" : "");
    for (std::size_t h = 0; h < 2; ++h)
      n += std::snprintf(text + n, sizeof text - std::size_t(n), " | %d: %.1f mm off, roll %.2f, handle %.2f of %.2f",
                         int(h), 1000 * length(tip(int(h), seen.wanted.tools[h]) - training::tip_of(m_model, state, h)),
                         double(seen.wanted.tools[h].roll) - state.tools[h].roll, state.tools[h].handle,
                         double(seen.wanted.tools[h].handle));
    return text;
  }

 private:
  static constexpr std::uint64_t kDelay = 150;  // ticks from what is seen to what is done
  static constexpr int kAfter = 3000;           // ticks
  static constexpr double kKnown = 0.9;         // of what its own hands have done since
  static constexpr double kStopped = 0.008;     // [m] that an instrument is behind its hand: something is in its way
  static constexpr double kPeriod = 4;          // [s] of the left hand's drawing and easing

  enum class Menu { closed, open };
  struct Seen {
    sim::Input wanted, commanded;
    std::array<kinematics::FulcrumPose, sim::kMaxTools> tool;
    std::array<double, sim::kMaxTools> handle{};
    sim::ScopeInput scope;
  };

  Vec3d tip(int hand, const sim::ToolInput& in) const {
    return kinematics::forward(m_model.hands[std::size_t(hand)].port, pose_of(in)).tip;
  }
  static double half_turn(double angle) {
    while (angle > 0.5 * portable::pi) angle -= portable::pi;
    while (angle < -0.5 * portable::pi) angle += portable::pi;
    return angle;
  }
  static double full_turn(double angle) {
    while (angle > portable::pi) angle -= 2 * portable::pi;
    while (angle < -portable::pi) angle += 2 * portable::pi;
    return angle;
  }
  bool exchanges(int hand, const sim::State& state) const {
    return m_wanted.tools[hand].instrument != state.tools[std::size_t(hand)].instrument;
  }

  /// How far a hand is behind what is wanted of it.
  struct Lag {
    double way = 0, turn = 0, handle = 0;  ///< [m] [rad] of the handle, that is to be closed
  };
  /// The right hand works: it is wanted elsewhere than a second ago, or burns. Nobody draws at tissue only to look at
  /// it.
  bool works(const sim::State& state) {
    const sim::ToolInput& wanted = m_wanted.tools[m_side[kRight]];
    const Vec3d at = tip(m_side[kRight], wanted);
    if (length(at - m_worked_at) > 1e-3 || (m_wanted.pedals & sim::kBlue) != 0) m_worked_at = at, m_worked = state.tick;
    return state.tick < m_worked + 1000;
  }
  bool eased() const { return std::fmod(m_swayed, kPeriod) < sim::kTick; }
  /// What is wanted of the left hand while it holds and the right one works: to the patient's right and back.
  Vec3d sway(const sim::State& state) const {
    const double wave = 0.5 * m_sway * (1 - portable::cos(2 * portable::pi * m_swayed / kPeriod));
    return state.tools[std::size_t(m_side[kLeft])].holds > 0 ? Vec3d{-wave, 0, 0} : Vec3d{};
  }
  Vec3d goal(int hand, const sim::ToolInput& in, const sim::State& state) const {
    return hand == m_side[kLeft] ? tip(hand, in) + sway(state) : tip(hand, in);
  }
  /// Jaws look the same after half a turn, a hook's foot and a needle that is held do not.
  bool looks_same_after_half(int hand, const sim::State& state) const {
    return grip_of(hand, state) == Grip::jaws && training::held_of_suture(m_model, state, std::size_t(hand)) == 0;
  }
  double turn_left(double angle, int hand, const sim::State& state) const {
    return looks_same_after_half(hand, state) ? half_turn(angle) : full_turn(angle);
  }
  Lag lag_of(int h, const sim::State& state) const {
    if (exchanges(h, state)) return {};
    const sim::ToolInput& wanted = m_wanted.tools[h];
    const interactions::ToolState& tool = state.tools[std::size_t(h)];
    const bool jaws = grip_of(h, state) == Grip::jaws;
    const Vec3d to = goal(h, wanted, state);
    // what a wall keeps from where it is wanted has been brought as near as a hand can
    const double way = std::min(length(to - training::tip_of(m_model, state, std::size_t(h))),
                                length(to - tip(h, m_commanded.tools[h])));
    return {way, std::fabs(turn_left(double(wanted.roll) - tool.roll, h, state)),
            jaws ? double(wanted.handle) - tool.handle : 0};
  }

  /// The demonstration goes on unless a hand is far behind; jaws close only where they were to. It does not wait for
  /// ever.
  void think(const sim::State& state) {
    constexpr double kFar = 0.006, kTurned = 0.35, kShut = 0.06, kHalf = 0.2;  // [m] [rad] of the handle
    constexpr double kThere = 0.0015, kSquare = 0.2;                           // [m] [rad]
    constexpr double kNeedleFar = Fingers::kNeedleFar,
                     kNeedleTurned = Fingers::kNeedleTurned;  // it goes where it is led
    constexpr int kPatience = 8000, kSettles = 1500;          // ticks
    bool behind = m_menu != Menu::closed, off = false;
    for (const int h : m_led) {
      behind |= m_pilot.inserting(h) || (m_inserts[std::size_t(h)] && !exchanges(h, state));
      const Lag lag = lag_of(h, state);
      const bool needle = training::held_of_suture(m_model, state, std::size_t(h)) == 1;
      behind |= lag.way > (needle ? kNeedleFar : kFar) || lag.turn > (needle ? kNeedleTurned : kTurned);
      behind |= lag.handle > (m_wanted.tools[h].handle > 0.8f ? kShut : kHalf) || lag.handle < -kHalf;
      off |= lag.way > kThere || lag.turn > kSquare;
    }
    if (m_settles > 0 && (--m_settles == 0 || !off)) m_wanted = m_closing, m_settles = 0;
    m_patience = behind || m_settles > 0 ? m_patience + 1 : 0;
    if (m_patience > 0 && m_patience < kPatience) {
      ++m_account.waiting;
      m_wanted.pedals &= ~std::uint32_t(sim::kBlue);  // nobody burns where the hand is not yet
      return;
    }
    const sim::Input was = m_wanted;
    m_wanted = m_brain->next(m_model, state);
    for (const int h : m_led)
      if (m_wanted.tools[h].handle > was.tools[h].handle && !m_squeezing[std::size_t(h)] && off) {
        m_closing = m_wanted;
        m_wanted.tools[h].handle = was.tools[h].handle;
        m_settles = kSettles;
      }
    for (const int h : m_led)
      m_squeezing[std::size_t(h)] = m_wanted.tools[h].handle > was.tools[h].handle || m_settles > 0;
  }

  void remember(const sim::State& state) {
    Seen& seen = m_seen[state.tick % kDelay];
    m_old = state.tick < kDelay ? m_seen[0] : seen;
    seen.wanted = m_wanted;
    seen.commanded = m_commanded;
    seen.scope = state.scope;
    for (std::size_t h = 0; h < m_model.hands.size(); ++h) {
      seen.tool[h] = state.tools[h].pose();
      seen.handle[h] = state.tools[h].handle;
    }
    if (state.tick == 0) m_old = seen;
  }

  Grip grip_of(int hand, const sim::State& state) const {
    return has_valves(m_model, state, hand)          ? Grip::valves
           : is_bare_electrode(m_model, state, hand) ? Grip::electrode
                                                     : Grip::jaws;
  }

  /// How far that hand is from where it was wanted, by what was seen then and by what it has done since.
  HandWish wish_of(int hand, const sim::State& state) const {
    const auto h = std::size_t(hand);
    HandWish wish;
    const sim::ToolInput& wanted = m_old.wanted.tools[hand];
    const Vec3d port = m_model.hands[h].port;
    wish.grip = grip_of(hand, state);
    wish.handle = double(wanted.handle);
    const bool own = !m_others || hand != Others::kHand;
    wish.handle_seen = own ? m_pilot.hands().handle[h] : double(m_commanded.tools[hand].handle);  // fingers feel it
    wish.locked = own && m_pilot.hands().ratchet[h];
    const std::uint32_t pedals = m_old.wanted.pedals;
    wish.squeeze = wish.grip == Grip::electrode ? (pedals & sim::kBlue) != 0
                                                : wish.grip == Grip::valves && (pedals & sim::sucks(hand)) != 0;
    wish.second = wish.grip == Grip::valves && (pedals & sim::irrigates(hand)) != 0;
    if (exchanges(hand, state) || m_pilot.changing(hand, state) || m_inserts[h] || m_pilot.inserting(hand)) return wish;
    const bool same = m_old.wanted.tools[hand].instrument == m_old.commanded.tools[hand].instrument &&
                      m_old.commanded.tools[hand].instrument == m_commanded.tools[hand].instrument;
    const Vec3d seen = kinematics::forward(port, m_old.tool[h]).tip;
    const Vec3d since = tip(hand, m_commanded.tools[hand]) - tip(hand, m_old.commanded.tools[hand]);
    // who sees that the instrument does not follow presses no farther than to where it is wanted
    const bool stopped = length(tip(hand, m_old.commanded.tools[hand]) - seen) > kStopped;
    const Vec3d at = !same     ? training::tip_of(m_model, state, h)
                     : stopped ? tip(hand, m_commanded.tools[hand])
                               : seen + kKnown * since;
    const Vec3d way = goal(hand, wanted, state) - at;
    const kinematics::ScopeFrame view = sim::scope_of(m_model, state);
    const Vec3d shaft = kinematics::forward(port, pose_of(m_commanded.tools[hand])).axis();
    // right and up in the picture, in along the shaft: not square to each other (Cramer's rule)
    const double det = dot(view.right, cross(view.up, shaft));
    if (std::fabs(det) > 0.1) {
      wish.right = dot(way, cross(view.up, shaft)) / det;
      wish.up = dot(view.right, cross(way, shaft)) / det;
      wish.in = dot(view.right, cross(view.up, way)) / det;
    } else {
      wish.right = dot(way, view.right), wish.up = dot(way, view.up);
    }
    const double rolled = double(m_commanded.tools[hand].roll) - double(m_old.commanded.tools[hand].roll);
    const double now = m_old.tool[h].roll + kKnown * rolled;
    double turn = turn_left(double(wanted.roll) - now, hand, state);
    // a wrist that can turn no further goes round the other way
    const double most = m_model.hands[h].rack[std::size_t(state.tools[h].instrument)].limits.roll - 0.05;
    const double round = looks_same_after_half(hand, state) ? portable::pi : 2 * portable::pi;
    if (now + turn > most) turn -= round;
    if (now + turn < -most) turn += round;
    wish.roll = -turn;
    return wish;
  }

  ScopeWish scope_wish(const sim::State& state) const {
    const sim::ScopeInput& wanted = m_old.wanted.scope;
    const Vec3d port = m_model.scope.port;
    const auto axis = [&](const sim::ScopeInput& s) { return kinematics::forward(port, pose_of(s)).axis(); };
    const Vec3d at = normalised(axis(m_old.scope) + kKnown * (axis(m_commanded.scope) - axis(m_old.commanded.scope)));
    const Vec3d way = axis(wanted) - at;
    const kinematics::ScopeFrame view = sim::scope_of(m_model, state);
    const Vec3d by_right = cross(-1.0 * view.up, at), by_up = cross(view.right, at);
    const double rr = dot(by_right, by_right), uu = dot(by_up, by_up), ru = dot(by_right, by_up);
    const double det = std::max(1e-6, rr * uu - ru * ru), wr = dot(way, by_right), wu = dot(way, by_up);
    ScopeWish wish;
    wish.right = (uu * wr - ru * wu) / det;
    wish.up = (rr * wu - ru * wr) / det;
    const auto left = [&](float sim::ScopeInput::*c) {
      return double(wanted.*c) -
             (double(m_old.scope.*c) + kKnown * (double(m_commanded.scope.*c) - double(m_old.commanded.scope.*c)));
    };
    wish.in = left(&sim::ScopeInput::depth);
    wish.head = -full_turn(left(&sim::ScopeInput::roll));
    wish.post = full_turn(left(&sim::ScopeInput::post));
    return wish;
  }

  /// One looks when the picture is well off, until it is right; with a hook under current one looks at nothing else.
  void decide_look(const ScopeWish& scope) {
    const double turn = std::hypot(scope.right, scope.up);
    if (!m_looks) {
      m_looks =
          turn > 0.14 || std::fabs(scope.in) > 0.012 || std::fabs(scope.post) > 0.35 || std::fabs(scope.head) > 0.3;
      m_account.looks += m_looks;
    } else {
      m_looks =
          turn > 0.03 || std::fabs(scope.in) > 0.003 || std::fabs(scope.post) > 0.09 || std::fabs(scope.head) > 0.06;
    }
  }

  void picture(const sim::State& state) {
    if (m_menu == Menu::open) return choose(state);
    Wish wish;
    wish.scope = scope_wish(state);
    for (const int s : {kLeft, kRight}) wish.side[std::size_t(s)] = wish_of(m_side[std::size_t(s)], state);
    if (!m_others) decide_look(wish.scope);
    wish.look = m_looks;
    wish.declare = (m_old.wanted.pedals & sim::kDeclare) != 0 || m_declares > 0;
    m_declares = (m_old.wanted.pedals & sim::kDeclare) != 0 ? 12 : std::max(0, m_declares - 1);
    bool hook = false;
    for (const HandWish& h : wish.side) hook |= h.grip == Grip::electrode;
    wish.blue = !hook && (m_old.wanted.pedals & sim::kBlue) != 0;
    if (!m_looks && !wish.declare)
      for (const int s : {kLeft, kRight})
        if (wants_another(m_side[std::size_t(s)], state)) wish.menu = s;
    bring_in(state, wish);
    const devices::HandSample sample = m_fingers.play(m_pilot.settings(), wish);
    m_commanded = with_others(m_pilot.lead(sample, state), state);
    if (m_pilot.asks_for_rack()) {
      m_menu = Menu::open;
      m_chosen = wish.menu >= 0 ? m_side[std::size_t(wish.menu)] : -1;
      m_reading = 0;
    }
  }
  const sim::Input& with_others(const sim::Input& own, const sim::State& state) {
    return m_others ? m_others->lead(own, scope_wish(state), wish_of(Others::kHand, state), state) : own;
  }
  /// Who has another instrument asks for it to come into the view, and turns the endoscope to it.
  void bring_in(const sim::State& state, Wish& wish) {
    for (const int s : {kLeft, kRight}) {
      const int hand = m_side[std::size_t(s)];
      bool& asks = m_inserts[std::size_t(hand)];
      if (asks && m_pilot.inserting(hand)) asks = false;
      if (asks && !m_pilot.changing(hand, state) && wish.menu < 0 && !wish.look) wish.insert = s;
    }
  }
  bool wants_another(int hand, const sim::State& state) const {
    return exchanges(hand, state) && !m_pilot.changing(hand, state);
  }

  /// The rack is on the screen: time goes on, and it is read and chosen from.
  void choose(const sim::State& state) {
    constexpr double kReads = 1.5;  // [s]
    m_commanded = with_others(m_pilot.rest(float(kPicture), state), state);
    if ((m_reading += kPicture) < kReads) return;
    if (m_chosen >= 0) {
      m_pilot.choose(m_chosen);
      m_pilot.take(m_wanted.tools[m_chosen].instrument);
      ++m_account.exchanges;
      m_inserts[std::size_t(m_chosen)] = true;
    }
    m_menu = Menu::closed;
    devices::HandSample rest;
    rest.dt = float(kPicture);
    m_pilot.take_up(rest);
  }

  void count(const sim::State& state) {
    constexpr double kMoves = 1e-3 * sim::kTick;  // [m] in a tick: 1 mm/s
    std::array<bool, 2> moved{};
    for (const std::size_t s : {0u, 1u}) {
      const Vec3d at = training::tip_of(m_model, state, std::size_t(m_side[s]));
      moved[s] = m_account.ticks > 0 && length(at - m_tip[s]) > kMoves;
      m_tip[s] = at;
    }
    ++m_account.ticks;
    m_account.left += moved[kLeft], m_account.right += moved[kRight];
    m_account.both += moved[kLeft] && moved[kRight];
    m_account.looking += m_pilot.both().looking, m_account.choosing += m_menu != Menu::closed;
  }

  const sim::Model& m_model;
  HandPilot m_pilot;
  SmoothInput m_smooth;
  Fingers m_fingers;
  std::array<int, 2> m_side{};       ///< hands
  std::vector<int> m_led;            ///< all of them that are led
  std::unique_ptr<Others> m_others;  ///< null: all is the operator's
  std::unique_ptr<training::Performer> m_brain;
  sim::Input m_wanted, m_commanded, m_closing;
  double m_sway = 0, m_swayed = 0;  ///< [m] [s]
  Vec3d m_worked_at;
  std::uint64_t m_worked = 0;
  std::array<bool, sim::kMaxTools> m_inserts{};
  int m_settles = 0;  ///< ticks for which jaws still wait before they close
  std::array<bool, sim::kMaxTools> m_squeezing{};
  std::array<Seen, kDelay> m_seen{};
  Seen m_old;  ///< what is seen
  double m_next_picture = 0, m_reading = 0;
  bool m_looks = false;
  Menu m_menu = Menu::closed;
  int m_chosen = -1, m_declares = 0, m_after = 0, m_patience = 0;
  std::array<Vec3d, 2> m_tip;
  RobotAccount m_account;
};

/// How it went.
struct Done {
  training::Score score;
  bool finished = false;
  int steps_done = 0;
  std::vector<std::string> errors;
  RobotAccount account;
};

/// Does an exercise with that device, for `longest` seconds at most, and says on stdout how. TROCAR_ROBOT_TRACE in the
/// environment tells a line a second on the way, TROCAR_ROBOT_SEED has another anatomy.
template <class Fingers>
Done do_with(const std::string& exercise, double longest, double sway = 0.003, bool alone = true) {
  const bool trace = std::getenv("TROCAR_ROBOT_TRACE") != nullptr;
  const char* seed = std::getenv("TROCAR_ROBOT_SEED");
  const std::unique_ptr<Lesson> lesson = load_lesson(exercise, seed ? std::strtoull(seed, nullptr, 10) : 0);
  Session session(*lesson);
  DeviceRobot<Fingers> robot(*lesson, sway, alone);
  sim::Input input;
  while (!session.finished() && double(session.state().tick) * sim::kTick < longest &&
         robot.next(session.state(), input)) {
    robot.after(session.state(), session.advance(input));
    if (!trace) continue;
    if (session.state().tick % 1000 == 0) std::fprintf(stderr, "%s\n", robot.now(session.state()).c_str());
    for (const Moment& m : session.moments())
      std::fprintf(stderr, "  %.2f s %s: %s\n", double(m.tick) * sim::kTick, m.what.c_str(), m.text.c_str());
  }
  const training::Monitor& judge = *session.monitor();
  Done done{judge.score(), judge.finished(), 0, {}, robot.account()};
  for (const training::StepStatus& step : judge.steps()) done.steps_done += step.done;
  for (const training::ErrorMade& e : judge.errors()) done.errors.push_back(e.code);
  const RobotAccount& a = done.account;
  std::printf("%s: %.1f s, score %.1f, errors", Fingers::kName, judge.seconds(), done.score.total);
  for (const std::string& code : done.errors) std::printf(" %s", code.c_str());
  std::printf(
      "; of the ticks the left hand moved in %.0f %%, the right one in %.0f %%, both in %.0f %%; endoscope led in %.0f "
      "%% "
      "(%d times), rack open in %.1f %% (%d exchanges), demonstration waited in %.0f %%\n",
      a.share(a.left), a.share(a.right), a.share(a.both), a.share(a.looking), a.looks, a.share(a.choosing), a.exchanges,
      a.share(a.waiting));
  return done;
}

}  // namespace trocar::attempt::robots
