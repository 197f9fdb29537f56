#include "shell/tones.hpp"

#include <algorithm>
#include <cmath>

#include <trocar/core/random.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::app {
namespace {

constexpr double kLoudest = 0.8;
constexpr double kAttack = 0.004, kRelease = 0.012;  // [s]

/// A sound that grows note by note.
class Sketch {
 public:
  explicit Sketch(int rate) : m_rate(rate) {}

  /// @param at begin [s], length [s], hertz, level 0..1; `rough` adds a beating neighbour
  void note(double at, double length, double hertz, double level, double rough = 0) {
    each(at, length, [&](double t) {
      const double pure = std::sin(2 * portable::pi * hertz * t) + 0.3 * std::sin(4 * portable::pi * hertz * t);
      return level * std::exp(-3 * t / length) * (pure + rough * std::sin(2 * portable::pi * 1.06 * hertz * t)) /
             (1.3 + rough);
    });
  }
  /// Noise that dies away: metal on metal.
  void snap(double at, double length, double level) {
    core::Random random(7);
    double last = 0;
    each(at, length, [&](double t) {
      const double white = double(random.next() >> 11) * 0x1p-52 - 1;
      last = 0.4 * last + 0.6 * white;
      return level * std::exp(-8 * t / length) * last;
    });
  }

  std::vector<std::int16_t> finish() const {
    std::vector<std::int16_t> out(m_sound.size());
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = std::int16_t(std::lround(32767 * kLoudest * std::clamp(m_sound[i], -1.0, 1.0)));
    return out;
  }

 private:
  template <class Wave>
  void each(double at, double length, Wave wave) {
    const std::size_t first = std::size_t(at * m_rate), count = std::size_t(length * m_rate);
    m_sound.resize(std::max(m_sound.size(), first + count + 1));
    for (std::size_t i = 0; i < count; ++i) {
      const double t = double(i) / m_rate, left = length - t;
      const double fade = std::min({1.0, t / kAttack, left / kRelease});
      m_sound[first + i] += fade * wave(t);
    }
  }

  int m_rate;
  std::vector<double> m_sound;
};

}  // namespace

std::vector<std::int16_t> samples_of(Tone tone, int rate) {
  Sketch s(rate);
  switch (tone) {
    case Tone::step_done:
      s.note(0, 0.14, 660, 0.6);
      s.note(0.11, 0.30, 880, 0.7);
      break;
    case Tone::error:
      s.note(0, 0.45, 165, 0.9, 0.9);
      break;
    case Tone::clip:
      s.snap(0, 0.05, 0.9);
      s.note(0, 0.08, 1900, 0.25);
      break;
    case Tone::cut:
      s.snap(0, 0.07, 0.6);
      s.snap(0.06, 0.06, 0.9);
      break;
    case Tone::touch:
      s.snap(0, 0.045, 0.5);
      break;
    case Tone::beat:
      s.note(0, 0.12, 80, 0.9);
      break;
    case Tone::warning:
      s.note(0, 0.09, 1320, 0.5);
      break;
    case Tone::finished:
      s.note(0, 0.16, 523, 0.6);
      s.note(0.13, 0.16, 659, 0.6);
      s.note(0.26, 0.5, 784, 0.8);
      break;
    case Tone::count:
      break;
  }
  return s.finish();
}

}  // namespace trocar::app
