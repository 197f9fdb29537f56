#include <algorithm>
#include <utility>

#include <trocar/devices/both_hands.hpp>
#include <trocar/devices/readings.hpp>

namespace trocar::devices {
namespace {

constexpr HelpLine kHelpBoth[] = {
    {Device::keyboard, "mouse", "moves one hand, as it does alone", HelpGroup::move, HelpNeeds::nothing},
    {Device::keyboard, "arrows, W S, Q E, G, Space, A D", "the other hand, as they do alone", HelpGroup::move,
     HelpNeeds::nothing},
    {Device::keyboard, "Tab", "exchange the hands of mouse and keyboard", HelpGroup::choose, HelpNeeds::nothing},
    {Device::keyboard, "1 2 3 4", "the mouse controls this hand; a third one replaces it", HelpGroup::choose,
     HelpNeeds::nothing},
    {Device::keyboard, "0 C", "mouse and keyboard control the endoscope, until Tab or a number", HelpGroup::choose,
     HelpNeeds::nothing},
    {Device::keyboard, "V X", "into view, exchange: for the hand last used", HelpGroup::choose, HelpNeeds::nothing},
    {Device::mouse, "side buttons", "mouse: left hand, right hand, endoscope", HelpGroup::choose, HelpNeeds::nothing},
    {Device::gamepad, "left, right stick", "tip of the left, of the right hand", HelpGroup::move, HelpNeeds::nothing},
    {Device::gamepad, "with its shoulder held", "up, down: deeper, back; sideways: roll", HelpGroup::move,
     HelpNeeds::nothing},
    {Device::gamepad, "with A held", "bend the wrists", HelpGroup::move, HelpNeeds::wrist},
    {Device::gamepad, "both shoulders held", "left stick: turn the endoscope; right: along it, roll; cross: light post",
     HelpGroup::move, HelpNeeds::nothing},
    {Device::gamepad, "left stick pressed", "everything fine: on, off", HelpGroup::move, HelpNeeds::nothing},
    {Device::gamepad, "left, right trigger", "close the left, the right jaws; suction; a hook coagulates",
     HelpGroup::act, HelpNeeds::nothing},
    {Device::gamepad, "cross left, right", "lock, unlock the left, the right jaws; water; a hook cuts", HelpGroup::act,
     HelpNeeds::nothing},
    {Device::gamepad, "trigger, cross of its side", "injection needle: draw, press the plunger", HelpGroup::act,
     HelpNeeds::needle},
    {Device::gamepad, "right stick pressed", "injection needle: into its shaft, out of it", HelpGroup::act,
     HelpNeeds::needle},
    {Device::gamepad, "cross up, down", "another hand in place of the one last used", HelpGroup::choose,
     HelpNeeds::nothing},
    {Device::gamepad, "both shoulders and Y", "one hand at a time", HelpGroup::choose, HelpNeeds::nothing},
    {Device::gamepad, "X, Y", "into view, exchange: for the hand last used", HelpGroup::choose, HelpNeeds::nothing},
};

constexpr Button kShoulders[2] = {Button::left_shoulder, Button::right_shoulder};
constexpr Button kLocks[2] = {Button::left, Button::right};
/// Keys that choose the controlled hand, or refer to the hand last used: no hand's own.
constexpr Key kChoosing[] = {Key::tab, Key::one, Key::two, Key::three, Key::four, Key::zero, Key::c, Key::v, Key::h};

int instruments_of(const HandSettings& settings) { return std::clamp(settings.instruments, 0, kMaxHands); }

// --- shares of a sample ---

/// A mouse as right-handed people hold it. The gamepad stays as it is: each side controls the hand of its own side.
HandSample as_meant(const HandSettings& settings, HandSample sample) {
  if (settings.left_handed) std::swap(sample.left_button, sample.right_button);
  return sample;
}

HandSettings settings_of_share(HandSettings settings) {
  settings.left_handed = false;
  return settings;
}

void take_out_choosing(KeySet& keys) {
  for (const Key key : kChoosing) keys.set(key, false);
}

/// Buttons that are the same whatever is controlled.
std::uint32_t common_buttons(const Gamepad& pad) {
  Gamepad common;
  for (const Button b : {Button::a, Button::b, Button::y, Button::right_stick}) common.set(b, pad.has(b));
  return common.buttons;
}

struct Stick {
  float x = 0, y = 0;
};

Stick stick_of(int side, const Gamepad& pad) {
  return side == kLeft ? Stick{pad.left_x, pad.left_y} : Stick{pad.right_x, pad.right_y};
}

bool tilted(const HandSettings& settings, const Stick& stick) {
  return std::max(std::abs(finite(stick.x)), std::abs(finite(stick.y))) > settings.stick_dead;
}

bool has_needle(int side, const BothHands& hands) {
  const std::size_t led = std::size_t(hands.pair[std::size_t(side)]);
  return hands.state.valves[led] && hands.state.needle[led];
}

/// A press on the right stick is meant for needles where there are any, else for the foot switch, once.
bool presses_stick(int side, const Gamepad& pad, const BothHands& hands) {
  if (!pad.has(Button::right_stick)) return false;
  return has_needle(kLeft, hands) || has_needle(kRight, hands) ? has_needle(side, hands) : side == kLeft;
}

/// One side of the pad as the whole pad of a hand that is controlled alone: with the shoulder the stick is the right
/// one.
Gamepad pad_share(int side, const Gamepad& pad, const BothHands& hands) {
  Gamepad share;
  const Stick stick = hands.away[std::size_t(side)] ? Stick{} : stick_of(side, pad);
  const bool bends = pad.has(Button::a) && hands.state.wrist[std::size_t(hands.pair[std::size_t(side)])];
  const bool shifted = pad.has(kShoulders[side]) || bends;
  (shifted ? share.right_x : share.left_x) = stick.x;
  (shifted ? share.right_y : share.left_y) = stick.y;
  share.right_trigger = side == kLeft ? pad.left_trigger : pad.right_trigger;
  share.left_trigger = pad.has(kLocks[side]) ? 1.0f : 0.0f;
  share.buttons = side == kLeft ? common_buttons(pad) : 0;  // once is enough
  share.set(Button::right_stick, presses_stick(side, pad, hands));
  if (bends) share.set(Button::a);
  return share;
}

HandSample share_of(int side, const HandSample& sample, const BothHands& hands) {
  HandSample share;
  share.dt = sample.dt;
  if (side == hands.mouse) {
    share.dx = sample.dx;
    share.dy = sample.dy;
    share.wheel = sample.wheel;
    share.left_button = sample.left_button;
    share.right_button = sample.right_button;
    share.middle_button = sample.middle_button;
    for (const Key key : {Key::shift, Key::u}) share.held.set(key, sample.held.has(key));
  } else {
    share.held = sample.held;
    share.pressed = sample.pressed;
    take_out_choosing(share.held);
    take_out_choosing(share.pressed);
    share.held.set(Key::u, false);
  }
  share.gamepad = pad_share(side, sample.gamepad, hands);
  return share;
}

/// Everything but what chooses is the endoscope's; the triggers are still the hands', so the cross turns the light
/// post.
HandSample share_of_scope(const HandSettings& settings, HandSample share) {
  take_out_choosing(share.held);
  take_out_choosing(share.pressed);
  share.back_button = share.forward_button = false;
  Gamepad& pad = share.gamepad;
  if (settings.left_handed) {
    std::swap(pad.left_x, pad.right_x);
    std::swap(pad.left_y, pad.right_y);
  }
  pad.left_trigger = pad.has(Button::left) ? 1.0f : 0.0f;
  pad.right_trigger = pad.has(Button::right) ? 1.0f : 0.0f;
  pad.buttons = common_buttons(pad);
  return share;
}

// --- which ones are controlled ---

bool both_shoulders(const HandSample& sample) {
  return sample.gamepad.has(Button::left_shoulder) && sample.gamepad.has(Button::right_shoulder);
}

/// H, or Y with both shoulders held. @param last  the sample before
bool asks_for_the_other_mode(const HandSample& sample, const HandSample& last) {
  return sample.pressed.has(Key::h) || (both_shoulders(sample) && went_down(Button::y, sample, last));
}

/// B with both shoulders held is K, and wipes no lens.
HandSample with_declaration(HandSample sample) {
  if (both_shoulders(sample) && sample.gamepad.has(Button::b)) {
    sample.gamepad.set(Button::b, false);
    sample.held.set(Key::k, true);
  }
  return sample;
}

void let_go(HandState& side) {
  side.opening = false;
  side.waiting = true;
}

void lead_side(int side, int instrument, BothHands& hands) {
  hands.used = side;
  if (hands.pair[std::size_t(side)] == instrument) return;
  hands.pair[std::size_t(side)] = instrument;
  let_go(hands.side[std::size_t(side)]);
}

int side_of(int instrument, const BothHands& hands) {
  return instrument == hands.pair[kLeft] ? kLeft : instrument == hands.pair[kRight] ? kRight : -1;
}

void choose_of_both(int hand, BothHands& hands) {
  hands.state.led = hand;
  if (hand == kScope) return;
  const int side = side_of(hand, hands);
  lead_side(side >= 0 ? side : hands.used, hand, hands);
}

void back_to_hands(BothHands& hands) {
  hands.state.led = hands.state.last_instrument = hands.pair[std::size_t(hands.used)];
}

void choose_for_mouse(int hand, BothHands& hands) {
  if (side_of(hand, hands) == 1 - hands.mouse) exchange(hands);
  hands.used = hands.mouse;
  choose_of_both(hand, hands);
}

/// The mouse goes round: left hand, right hand, endoscope.
void step_mouse(int step, BothHands& hands) {
  constexpr int kPlaces = 3, kScopePlace = 2;
  const int here = hands.state.led == kScope ? kScopePlace : hands.mouse;
  const int there = (here + step + kPlaces) % kPlaces;
  if (there == kScopePlace)
    hands.state.led = kScope;
  else
    choose_for_mouse(hands.pair[std::size_t(there)], hands);
}

/// The next instrument that is not in the pair takes the place of the one last used.
void choose_another(int step, int instruments, BothHands& hands) {
  int hand = hands.pair[std::size_t(hands.used)];
  for (int i = 0; i < instruments; ++i) {
    hand = (hand + step + instruments) % instruments;
    if (side_of(hand, hands) < 0) return choose_of_both(hand, hands);
  }
}

void choose_by_keys(const HandSettings& settings, const HandSample& sample, BothHands& hands) {
  const int instruments = instruments_of(settings);
  for (int i = 0; i < instruments; ++i)
    if (sample.pressed.has(kNumberKeys[i])) choose_for_mouse(settings.left_handed ? instruments - 1 - i : i, hands);
  if (sample.pressed.has(Key::tab)) {
    if (hands.state.led == kScope)
      back_to_hands(hands);
    else
      exchange(hands);
  }
  if (sample.pressed.has(Key::zero) || sample.pressed.has(Key::c)) hands.state.led = kScope;
}

/// @param last  the sample before
void choose_by_buttons(const HandSettings& settings, const HandSample& sample, const HandSample& last,
                       BothHands& hands) {
  if (sample.back_button && !last.back_button) step_mouse(-1, hands);
  if (sample.forward_button && !last.forward_button) step_mouse(+1, hands);
  const auto down = [&](Button b) { return went_down(b, sample, last); };
  if (hands.state.led == kScope && (down(Button::left_shoulder) || down(Button::right_shoulder))) back_to_hands(hands);
  if (hands.state.led == kScope || both_shoulders(sample)) return;
  if (down(Button::up)) choose_another(+1, instruments_of(settings), hands);
  if (down(Button::down)) choose_another(-1, instruments_of(settings), hands);
}

/// Who holds the mouse in the left hand leads the left instrument by it.
void know_mouse(const HandSettings& settings, BothHands& hands) {
  hands.mouse = hands.exchanged == settings.left_handed ? kRight : kLeft;
}

/// Whose devices have become others' keeps its grip.
void choose_pair(const HandSettings& settings, const HandSample& sample, const HandSample& last, BothHands& hands) {
  know_mouse(settings, hands);
  const std::array<int, 2> pair = hands.pair;
  const int mouse = hands.mouse;
  choose_by_keys(settings, sample, hands);
  choose_by_buttons(settings, sample, last, hands);
  for (const int s : {kLeft, kRight})
    if (pair[std::size_t(s)] != hands.pair[std::size_t(s)] || mouse != hands.mouse)
      take_up(settings_of_share(settings), share_of(s, sample, hands), hands.side[std::size_t(s)]);
}

// --- what they do ---

bool pulls(const HandSample& share) { return squeezes(share) || finite(share.gamepad.right_trigger) > kTriggerTouched; }

/// The endoscope is controlled instead. Who lets go meanwhile keeps the grip; who holds on is in charge of it
/// afterwards.
void keep(const HandSettings& settings, const HandSample& share, HandState& side) {
  const bool holds_on = side.opening && pulls(share);
  take_up(settings_of_share(settings), share, side);
  side.opening = holds_on;
  side.waiting = pulls(share) && !holds_on;
}

HandCommand lead_one(const HandSettings& settings, const HandSample& share, int instrument, HandState& side,
                     HandState& all) {
  side.led = instrument;
  side.handle = all.handle;
  side.ratchet = all.ratchet;
  side.valves = all.valves;
  side.needle = all.needle;
  side.electrode = all.electrode;
  side.wrist = all.wrist;
  side.fine = all.fine;
  const HandCommand command = lead(settings_of_share(settings), share, side);
  all.handle = side.handle;
  all.ratchet = side.ratchet;
  return command;
}

bool acts(const HandCommand& c, const HandSample& share) {
  return c.tip.right != 0 || c.tip.up != 0 || c.tip.in != 0 || c.roll != 0 || c.wrist.right != 0 || c.wrist.up != 0 ||
         c.suck || c.irrigate || pulls(share);
}

/// The side whose shoulder is held, or that does something while the other one rests.
void notice_used(const HandSample& sample, const std::array<bool, 2>& acting, BothHands& hands) {
  const bool left = sample.gamepad.has(Button::left_shoulder), right = sample.gamepad.has(Button::right_shoulder);
  if (left != right)
    hands.used = left ? kLeft : kRight;
  else if (!acting[std::size_t(hands.used)] && acting[std::size_t(1 - hands.used)])
    hands.used = 1 - hands.used;
  back_to_hands(hands);
}

HandCommands lead_pair(const HandSettings& settings, const HandSample& sample, bool insert, BothHands& hands) {
  std::array<HandCommand, 2> each;
  std::array<bool, 2> acting;
  for (std::size_t s = 0; s < 2; ++s) {
    hands.away[s] = hands.away[s] && tilted(settings, stick_of(int(s), sample.gamepad));
    const HandSample share = share_of(int(s), sample, hands);
    each[s] = lead_one(settings, share, hands.pair[s], hands.side[s], hands.state);
    acting[s] = acts(each[s], share);
  }
  keep(settings, share_of_scope(settings, sample), hands.scope);
  notice_used(sample, acting, hands);
  each[std::size_t(hands.used)].insert = insert;
  HandCommands commands;
  for (const HandCommand& command : each) commands.add(command);
  return commands;
}

HandCommands lead_scope(const HandSettings& settings, const HandSample& sample, bool insert, BothHands& hands) {
  for (std::size_t s = 0; s < 2; ++s) {
    hands.away[s] = true;
    keep(settings, share_of(int(s), sample, hands), hands.side[s]);
  }
  HandCommands commands;
  commands.add(lead_one(settings, share_of_scope(settings, sample), kScope, hands.scope, hands.state));
  if (insert) {  // it comes where the endoscope looks
    HandCommand comes;
    comes.led = hands.pair[std::size_t(hands.used)];
    comes.insert = true;
    commands.add(comes);
  }
  return commands;
}

}  // namespace

bool leads_both(const HandSettings& settings, const BothHands& hands) noexcept {
  return hands.on && instruments_of(settings) >= 2;
}

HandCommands lead(const HandSettings& settings, const HandSample& from_devices, BothHands& hands) noexcept {
  const HandSample given = with_declaration(from_devices);
  const HandSample last = std::exchange(hands.last, given);
  if (asks_for_the_other_mode(given, last) && instruments_of(settings) >= 2) {
    lead_both(settings, !hands.on, hands);
    take_up(settings, given, hands);  // that Y is old, and not the rack's
  }
  HandCommands commands;
  if (!leads_both(settings, hands)) {
    hands.looking = false;
    commands.add(lead(settings, given, hands.state));
    return commands;
  }
  const HandSample sample = as_meant(settings, given);
  choose_pair(settings, sample, last, hands);
  if (went_down(Button::left_stick, sample, last)) hands.state.fine = !hands.state.fine;
  hands.looking = hands.state.led == kScope || both_shoulders(sample);
  const bool insert = sample.pressed.has(Key::v) || went_down(Button::x, sample, last);
  return hands.looking ? lead_scope(settings, sample, insert, hands) : lead_pair(settings, sample, insert, hands);
}

void lead_both(const HandSettings& settings, bool on, BothHands& hands) noexcept {
  if (on == hands.on) return;
  hands.on = on;
  hands.looking = false;
  if (!on && instruments_of(settings) >= 2) choose(hands.alone, hands.state);
  let_go(hands.state);
  if (!leads_both(settings, hands)) return;
  hands.alone = hands.state.led;
  for (HandState& side : hands.side) side = {}, let_go(side);
  hands.scope = {};
  hands.away = {true, true};
  if (hands.state.led == kScope)
    back_to_hands(hands);
  else
    choose_of_both(hands.state.led, hands);
}

void choose(const HandSettings& settings, int hand, BothHands& hands) noexcept {
  if (leads_both(settings, hands))
    choose_of_both(hand, hands);
  else
    choose(hand, hands.state);
}

void exchange(BothHands& hands) noexcept {
  hands.exchanged = !hands.exchanged;
  hands.mouse = 1 - hands.mouse;
}

void take_up(const HandSettings& settings, const HandSample& given, BothHands& hands) noexcept {
  take_up(settings, given, hands.state);
  const HandSample sample = as_meant(settings, given);
  const HandSettings own = settings_of_share(settings);
  know_mouse(settings, hands);
  for (const int s : {kLeft, kRight}) take_up(own, share_of(s, sample, hands), hands.side[std::size_t(s)]);
  take_up(own, share_of_scope(settings, sample), hands.scope);
  hands.last = given;
}

std::span<const HelpLine> help_both() noexcept { return kHelpBoth; }

}  // namespace trocar::devices
