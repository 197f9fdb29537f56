// Both hands at once: two instruments, the pair, move in the same sample. A gamepad controls the left hand by what lies
// at its left and the right hand by what lies at its right; mouse and keys control one hand each. Every hand gets its
// share of the sample and is controlled by it as a hand alone would be, see mouse_keyboard.hpp: jaws, locks, valves,
// grips that are taken up where they were left are the same. While the mode is off, or where there are not two
// instruments, all is as lead() of one hand has it.
//
//   BothHands hands;                                              // lives as long as the session
//   for (const HandCommand& c : lead(settings, sample, hands))    // one hand, two hands, or the endoscope
//     move c.led as for one
//   handle[i] = hands.state.handle[i]                             // of every instrument, led or not
//
// The gamepad: a stick moves its side's tip, and while that side's shoulder is held goes deeper and back and rolls;
// triggers close the jaws of their sides, the cross to the left and to the right locks them (or opens the water), up
// and down put another instrument in the place of the one last used. Both shoulders held: the left stick looks, the
// right one goes along the shaft and turns the picture, and both hands keep pose and grip; a stick comes to rest before
// it leads its hand again.
//
// Mouse and keys: Tab exchanges them; a number is the hand that the mouse is to lead, and one that is not of the pair
// takes the mouse's hand's place; 0 or C takes the endoscope for all devices until a hand is chosen again.
#pragma once

#include <trocar/devices/mouse_keyboard.hpp>

namespace trocar::devices {

inline constexpr int kLeft = 0, kRight = 1;  ///< sides

/// What must be remembered of one hand or both between samples.
struct BothHands {
  /// Handles, locks and valves of all instruments, and which one is controlled alone. Of both, `led` is the one last
  /// used: what is chosen in the rack or brought into the view is for it; kScope as long as the endoscope was chosen.
  HandState state;
  bool on = false;                ///< wanted: it takes two instruments, see leads_both()
  std::array<int, 2> pair{0, 1};  ///< instruments of the left, the right side
  int used = kRight;              ///< the side last used
  int mouse = kRight;             ///< the side that the mouse leads, the keys lead the other one
  bool exchanged = false;         ///< ... which is not that of the hand that leads a mouse
  int alone = 0;                  ///< controlled when the mode began, and again when it ends
  bool looking = false;           ///< the endoscope is controlled, both hands keep pose and grip
  std::array<HandState, 2> side;  ///< of each hand's share of the samples
  HandState scope;
  std::array<bool, 2> away{};  ///< this stick led something else and comes to rest first
  HandSample last;             ///< as given, to notice presses
};

/// One, or the two that are controlled at once.
class HandCommands {
 public:
  void add(const HandCommand& command) { m_each[std::size_t(m_count++)] = command; }
  const HandCommand* begin() const { return m_each.data(); }
  const HandCommand* end() const { return m_each.data() + m_count; }
  int size() const { return m_count; }

 private:
  std::array<HandCommand, 2> m_each;
  int m_count = 0;
};

/// Are both led?
bool leads_both(const HandSettings& settings, const BothHands& hands) noexcept;

/// One sample: moves `hands` on and reports what the controlled ones do.
HandCommands lead(const HandSettings& settings, const HandSample& sample, BothHands& hands) noexcept;

/// Both, or the one that was controlled before: every handle keeps its grip. A take_up() with the next sample follows.
void lead_both(const HandSettings& settings, bool on, BothHands& hands) noexcept;
/// Of both: `hand` becomes the one last used; one that is not of the pair takes that one's place. Else as for one.
void choose(const HandSettings& settings, int hand, BothHands& hands) noexcept;
/// The mouse controls the hand that the keys controlled. A take_up() with the next sample follows.
void exchange(BothHands& hands) noexcept;
/// As for one: whatever is held down now counts as old, every handle keeps its grip until it is squeezed again.
void take_up(const HandSettings& settings, const HandSample& sample, BothHands& hands) noexcept;

/// The table of keys of this mode, beside help(); what is not in it is as for one hand.
std::span<const HelpLine> help_both() noexcept;

}  // namespace trocar::devices
