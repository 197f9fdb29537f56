// How old what is on the screen is: from the hand to the first picture that shows what it did, as given to the screen.
// What the screen itself takes is not known here.
//
//   age.shown(news.acquired, now);       // after every picture
//   if (age.known()) tell(age.smoothed());
#pragma once

#include <algorithm>
#include <cstdint>

namespace trocar::app {

class PictureAge {
 public:
  /// @param acquired when what leads was measured [ns], 0: it does not say; @param now [s], of the same clock
  void shown(std::int64_t acquired, double now) {
    if (acquired == m_shown) return;
    m_shown = acquired;
    constexpr int kFirstPictures = 20;  // they wait for shaders to be compiled
    if (++m_pictures <= kFirstPictures) return;
    const double age = now - 1e-9 * double(acquired);
    m_smoothed = m_ages == 0 ? age : m_smoothed + 0.05 * (age - m_smoothed);
    m_sum += age;
    m_most = std::max(m_most, age);
    ++m_ages;
  }

  bool known() const { return m_ages > 0; }
  double smoothed() const { return m_smoothed; }          ///< [s]
  double mean() const { return m_sum / double(m_ages); }  ///< [s], where known()
  double most() const { return m_most; }                  ///< [s]

 private:
  std::int64_t m_shown = 0;  ///< of the last picture that showed something newer
  int m_pictures = 0;        ///< with something newer
  std::uint64_t m_ages = 0;
  double m_smoothed = 0, m_sum = 0, m_most = 0;
};

}  // namespace trocar::app
