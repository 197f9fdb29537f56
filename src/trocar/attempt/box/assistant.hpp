// Finds out how a box is wired, and calibrates it, by questions to the user: which channel moves when they
// move an axis, what it reads where they hold it still at a known angle, which bit a pedal is. Knows nothing of
// windows.
//
//   BoxAssistant assistant(basis, parts);
//   assistant.see(pose.block, pose.acquired);                       // every block, all channels
//   if (assistant.ready() && key) say(assistant.take());            // empty: taken, the next question is there
//   if (assistant.done()) write(box_file_text(assistant.wiring()));
#pragma once

#include <array>
#include <deque>
#include <string>
#include <vector>

#include <trocar/devices/box/box_time.hpp>
#include <trocar/devices/box/wiring.hpp>

namespace trocar::attempt {

/// What a box has.
struct BoxParts {
  std::array<bool, devices::kBoxActors> actors = {true, true, false, false, true};
  bool pedals = true;   ///< foot switches
  bool buttons = true;  ///< on the hands' handles

  bool any() const;
};

struct BoxQuestion {
  enum class Kind {
    sweep,  ///< move this axis alone, through all its reach: finds the channel
    hold,   ///< hold it still at `value`: a row of its table
    press   ///< press and let go: finds the bit
  };
  Kind kind = Kind::sweep;
  devices::BoxActor actor = devices::BoxActor::left;
  devices::BoxAxis axis = devices::BoxAxis::yaw;
  double value = 0;                ///< of hold: [rad], [m], 0 .. 1
  int pedal = -1, button = -1;     ///< of press: one of them
  std::string heading, text = {};  ///< for people: what it is about, what they shall do
};

class BoxAssistant {
 public:
  static constexpr double kLeastSweep = 300;  ///< codes that an axis has to move, of 4096
  static constexpr double kMostUnrest = 24;   ///< codes that a held axis may move, 0.9 degrees of 120
  static constexpr double kLeastApart = 40;   ///< codes between two rows

  /// @param basis  what is not asked is as there: line, filter, zero
  BoxAssistant(const devices::BoxWiring& basis, const BoxParts& parts);

  /// Every block as it comes, with all channels.
  void see(const devices::BoxBlock& block, devices::BoxTime at);

  bool done() const { return m_at == m_questions.size(); }
  const BoxQuestion& question() const { return m_questions[m_at]; }  ///< not when it is done
  std::size_t number() const { return m_at; }
  std::size_t count() const { return m_questions.size(); }

  /// What the question is about, as far as it has been found: a channel or a bit; -1: none yet.
  int found() const;
  /// By how much that channel has moved since the question began, or in the last half second where it is to be held.
  double moved() const;
  /// Would it be taken?
  bool ready() const { return why_not().empty(); }
  /// In words what keeps the answer from being taken; empty: nothing does.
  std::string why_not() const;

  /// @returns why_not(); where that is empty the answer is taken and the next question is there
  std::string take();
  /// The same question at another value: the scale that was at hand shows another angle.
  void set_value(double value);
  /// One more row for the axis that is being held, after the rows that are still to come.
  void add_row(double value);
  /// The axis whose channel is looked for is this one's, whatever moved most. @returns why not, or nothing
  std::string choose(int channel);
  /// There is no such axis or switch.
  void skip();
  bool can_go_back() const { return !m_past.empty(); }
  void back();

  const devices::BoxWiring& wiring() const { return m_wiring; }

 private:
  struct Moment {
    devices::BoxBlock block;
    devices::BoxTime at = 0;
  };
  struct Past {
    std::size_t at;
    std::vector<BoxQuestion> questions;
    devices::BoxWiring wiring;
  };
  devices::WiredAxis& axis();
  const devices::WiredAxis& axis() const;
  void ask_axis(devices::BoxActor actor, devices::BoxAxis which);
  void ask_press(devices::BoxActor actor, int pedal, int button);
  void remember();
  void begin();
  bool channel_taken(int channel) const;
  bool bit_taken(int bit) const;
  int most_moved(int except) const;
  double range(int channel) const;
  double held_code(int channel) const;
  double unrest(int channel) const;
  std::string why_not_swept() const;
  std::string why_not_held() const;
  std::string why_not_pressed() const;

  std::vector<BoxQuestion> m_questions;
  std::size_t m_at = 0;
  devices::BoxWiring m_wiring;
  std::vector<Past> m_past;
  std::deque<Moment> m_recent;                               ///< the last half second
  std::array<double, devices::kBoxChannels> m_low, m_high;   ///< since the question began
  std::uint32_t m_rest = 0, m_pressed = 0, m_came_back = 0;  ///< bits: at first, changed since, and back again
  bool m_begun = false;                                      ///< a block has come since
};

}  // namespace trocar::attempt
