// What the trainee is told the moment it happens: a line near the picture for some seconds, a sound, and a list that
// stays. Pure logic; panel.hpp draws it.
//
//   Feedback feedback;
//   if (const Notice* n = feedback.add(moment, clock, now)) sound.play(n->tone);
//   for (const Notice* n : feedback.fresh(now)) ...draw near the picture
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <trocar/attempt/session.hpp>

#include "shell/tones.hpp"
#include "shell/ui.hpp"

namespace trocar::app {

struct Notice {
  ui::Mark mark = ui::Mark::note;
  std::string text;
  double clock = 0;          ///< on the exercise's clock [s]
  double until = 0;          ///< shown near the picture up to this real time [s]; 0: in the list only
  std::optional<Tone> tone;  ///< how it sounds
};

class Feedback {
 public:
  /// @param clock the exercise's [s]  @param now real time [s]
  /// @returns the notice, or null where a moment is not worth telling
  const Notice* add(const attempt::Moment& moment, double clock, double now);
  const Notice* add(ui::Mark mark, const std::string& text, double clock, double now);

  const std::vector<Notice>& all() const { return m_notices; }  ///< oldest first, at most kMost
  std::vector<const Notice*> fresh(double now) const;           ///< newest last, at most kMostFresh

  static constexpr std::size_t kMost = 200, kMostFresh = 3;

 private:
  const Notice* push(Notice notice);
  std::vector<Notice> m_notices;
};

/// Seconds of an attempt as minutes and seconds, "2:07".
std::string clock_text(double seconds);

/// Tells when to warn of a pull that comes near its limit: at once, then every so often as long as it lasts.
class PullWarning {
 public:
  bool due(double pull, double limit, double now);

 private:
  double m_next = 0;
  bool m_near = false;
};

}  // namespace trocar::app
