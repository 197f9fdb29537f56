// Inputs that somebody made (a demonstration, a recording, a motion file) as what a box would measure while hands do
// them: what the software box plays.
//
//   BoxPlayback playback(model, wiring, inputs_of_demonstration(lesson));
//   SoftwareBox box(settings, [&](double seconds) { return playback.at(seconds); });
#pragma once

#include <string>
#include <vector>

#include <trocar/attempt/box/box_hands.hpp>
#include <trocar/attempt/lesson.hpp>

namespace trocar::attempt {

class BoxPlayback {
 public:
  /// @param inputs  one a tick, at least one
  /// @param lead_in  how long the first one is held before [s]
  BoxPlayback(const sim::Model& model, const devices::BoxWiring& wiring, std::vector<sim::Input> inputs,
              double lead_in = 1);

  devices::BoxBlock at(double seconds) const;
  double duration() const;  ///< [s], with what is held before
  /// By how much the inputs are at most beyond what each channel can say.
  const devices::BoxAngles& beyond() const { return m_beyond; }

  static constexpr double kPress = 0.06;  ///< [s] that a button is down, and up before the next press

 private:
  struct Press {
    double from = 0;  ///< [s]
    int bit = -1;
  };
  void press_for_changes();

  BoxHands m_hands;
  std::vector<sim::Input> m_inputs;
  std::vector<int> m_rack;  ///< (hands) instruments of each
  std::vector<Press> m_presses;
  double m_lead_in;
  devices::BoxAngles m_beyond{};
};

/// What the exercise's demonstration did: it is performed once, without a window, and may have to pass.
/// @param told  called now and then with the seconds that are performed; false ends it
/// @throws core::BadInput where nobody knows how, or where it does not pass
std::vector<sim::Input> inputs_of_demonstration(const Lesson& lesson, const std::function<bool(double)>& told = {});
/// What `motion` (as behind --input motion:) makes two instruments of the scene do.  @throws core::BadInput
std::vector<sim::Input> inputs_of_motion(const Lesson& lesson, const std::string& motion);
/// Slow waves of every hand around where it is placed: 40 s.
std::vector<sim::Input> waving_inputs(const sim::Model& model);
/// The same without a scene: every wired channel through four fifths of its table.
devices::BoxBlock waving_block(const devices::BoxWiring& wiring, double seconds);

}  // namespace trocar::attempt
