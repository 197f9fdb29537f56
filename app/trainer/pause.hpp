// The pause menu. What would throw an attempt away by one press asks first.
#pragma once

#include <string>

#include "trainer/choice.hpp"

namespace trocar::app {

class PauseMenu {
 public:
  struct About {
    std::string why;        ///< it is paused, where nobody asked for it; or empty
    std::string recording;  ///< where the attempt is recorded; or empty
    bool scored = false;    ///< the attempt counts
    bool display = false;   ///< how things are shown may be chosen: not while it counts
  };
  /// One picture of it. @param back  Esc or the gamepad's B was pressed
  /// @returns finish and restart only after they were confirmed
  Choice draw(const About& about, bool back);
  /// Does it ask whether to end or to restart?
  bool asks() const { return m_asked != Choice::none; }
  void forget() { m_asked = Choice::none; }

 private:
  Choice draw_menu(const About& about);
  Choice draw_question(bool scored, bool back);

  Choice m_asked = Choice::none;  ///< finish or restart, which waits to be confirmed
};

}  // namespace trocar::app
