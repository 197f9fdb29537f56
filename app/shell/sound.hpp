// Plays tones through OpenAL Soft: small, kept well, on every Debian, speaks to PipeWire, PulseAudio and ALSA, and
// mixes. A machine without a sound device is silent and nobody is told: feedback is seen as well as heard.
//
//   Sound sound;                       // returns at once; the device is opened on a thread of its own
//   sound.set_volume(0.7);
//   sound.play(Tone::step_done);
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "shell/tones.hpp"

namespace trocar::app {

class Sound {
 public:
  Sound();
  ~Sound();
  Sound(const Sound&) = delete;
  Sound& operator=(const Sound&) = delete;

  void set_volume(double volume) { m_volume.store(float(volume)); }  ///< 0..1
  void play(Tone tone, float level = 1);                             ///< level: of the volume, 0..1
  bool audible() const { return m_audible.load(); }                  ///< a device was found

 private:
  void loop();

  std::atomic<float> m_volume{0.7f};
  std::atomic<bool> m_audible{false};
  std::mutex m_lock;
  std::condition_variable m_wake;
  struct Wanted {
    Tone tone = Tone::count;
    float level = 1;
  };
  std::deque<Wanted> m_wanted;
  bool m_stop = false;
  std::thread m_thread;  // last
};

}  // namespace trocar::app
