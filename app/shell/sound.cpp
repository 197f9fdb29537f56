#include "shell/sound.hpp"

#include <array>
#include <cstdlib>

#include <AL/al.h>
#include <AL/alc.h>
#include <dlfcn.h>

namespace trocar::app {
namespace {

constexpr int kRate = 44100;
constexpr std::size_t kVoices = 6;  // sounds at once; the oldest gives way
constexpr std::size_t kMostWanted = 8;

void say_nothing(const char*, int, const char*, int, const char*, ...) {}

/// ALSA, which OpenAL loads, writes pages to stderr where there is no device. It has a function to be told not to.
void hush_libraries() {
  using Handler = void (*)(const char*, int, const char*, int, const char*, ...);
  void* alsa = dlopen("libasound.so.2", RTLD_NOW | RTLD_GLOBAL);
  if (!alsa) return;
  using SetHandler = int (*)(Handler);
  if (const auto set = reinterpret_cast<SetHandler>(dlsym(alsa, "snd_lib_error_set_handler"))) set(say_nothing);
}

/// An open device with every tone in a buffer.
class Loudspeaker {
 public:
  Loudspeaker() {
    hush_libraries();
    m_device = alcOpenDevice(nullptr);
    if (!m_device) return;
    m_context = alcCreateContext(m_device, nullptr);
    if (!m_context || !alcMakeContextCurrent(m_context)) return;
    alGenBuffers(ALsizei(m_buffers.size()), m_buffers.data());
    alGenSources(ALsizei(m_sources.size()), m_sources.data());
    for (std::size_t i = 0; i < m_buffers.size(); ++i) {
      const std::vector<std::int16_t> sound = samples_of(Tone(i), kRate);
      alBufferData(m_buffers[i], AL_FORMAT_MONO16, sound.data(), ALsizei(2 * sound.size()), kRate);
    }
    m_good = alGetError() == AL_NO_ERROR;
  }
  ~Loudspeaker() {
    if (m_good) {
      alDeleteSources(ALsizei(m_sources.size()), m_sources.data());
      alDeleteBuffers(ALsizei(m_buffers.size()), m_buffers.data());
    }
    alcMakeContextCurrent(nullptr);
    if (m_context) alcDestroyContext(m_context);
    if (m_device) alcCloseDevice(m_device);
  }
  Loudspeaker(const Loudspeaker&) = delete;
  Loudspeaker& operator=(const Loudspeaker&) = delete;

  bool good() const { return m_good; }
  void play(Tone tone, float volume) {
    const ALuint source = m_sources[m_next++ % kVoices];
    alSourceStop(source);
    alSourcei(source, AL_BUFFER, ALint(m_buffers[std::size_t(tone)]));
    alSourcef(source, AL_GAIN, volume);
    alSourcePlay(source);
  }

 private:
  ALCdevice* m_device = nullptr;
  ALCcontext* m_context = nullptr;
  std::array<ALuint, std::size_t(Tone::count)> m_buffers{};
  std::array<ALuint, kVoices> m_sources{};
  std::size_t m_next = 0;
  bool m_good = false;
};

}  // namespace

Sound::Sound() {
  setenv("ALSOFT_LOGLEVEL", "0", 0);
  m_thread = std::thread([this] { loop(); });
}

Sound::~Sound() {
  {
    const std::lock_guard lock(m_lock);
    m_stop = true;
  }
  m_wake.notify_one();
  m_thread.join();
}

void Sound::play(Tone tone, float level) {
  {
    const std::lock_guard lock(m_lock);
    if (m_wanted.size() < kMostWanted) m_wanted.push_back({tone, level});
  }
  m_wake.notify_one();
}

void Sound::loop() {
  Loudspeaker loudspeaker;
  m_audible.store(loudspeaker.good());
  std::unique_lock lock(m_lock);
  while (!m_stop) {
    m_wake.wait(lock, [this] { return m_stop || !m_wanted.empty(); });
    while (!m_wanted.empty()) {
      const Wanted wanted = m_wanted.front();
      m_wanted.pop_front();
      const float volume = m_volume.load() * wanted.level;
      lock.unlock();  // a device may take its time: the window does not wait for it
      if (loudspeaker.good() && volume > 0) loudspeaker.play(wanted.tone, volume);
      lock.lock();
    }
  }
}

}  // namespace trocar::app
