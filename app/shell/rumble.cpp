#include "shell/rumble.hpp"

#include <algorithm>
#include <cmath>

#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace trocar::app {
namespace {

constexpr int kMostDevices = 64;       // /dev/input/event0 ...
constexpr std::uint16_t kLasts = 300;  // [ms] of an effect: a program that dies leaves no motor running
constexpr double kAgain = 0.15;        // [s] after which it is sent anew
constexpr double kChange = 0.02;       // [s] between changes
constexpr int kLevelStep = 2000;       // of the level, that is a change

int digit_of(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

/// Can this file turn motors, and is it that pad?
bool is_pad(int device, const PadIds& ids) {
  input_id id{};
  unsigned char has[FF_MAX / 8 + 1]{};
  if (ioctl(device, EVIOCGID, &id) < 0 || ioctl(device, EVIOCGBIT(EV_FF, sizeof has), has) < 0) return false;
  const bool rumbles = (has[FF_RUMBLE / 8] >> (FF_RUMBLE % 8)) & 1;
  return rumbles && PadIds{id.bustype, id.vendor, id.product, id.version} == ids;
}

int find_pad(const PadIds& ids) {
  for (int i = 0; i < kMostDevices; ++i) {
    const int device = open(("/dev/input/event" + std::to_string(i)).c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (device < 0) continue;
    if (is_pad(device, ids)) return device;
    close(device);
  }
  return -1;
}

}  // namespace

std::optional<PadIds> ids_of_guid(const std::string& guid) {
  if (guid.size() != 32) return {};
  std::uint16_t words[8]{};
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t k : {2u, 3u, 0u, 1u}) {  // the low byte stands first
      const int d = digit_of(guid[4 * i + k]);
      if (d < 0) return {};
      words[i] = std::uint16_t(words[i] << 4 | d);
    }
  if (words[1] != 0 || words[2] == 0 || words[3] != 0 || words[5] != 0 || words[7] != 0) return {};
  return PadIds{words[0], words[2], words[4], words[6]};
}

std::uint16_t motor_level(double share) {
  return std::uint16_t(std::lround(65535 * std::clamp(std::isfinite(share) ? share : 0.0, 0.0, 1.0)));
}

void Rumble::let_go() {
  if (m_device < 0) return;
  if (m_effect >= 0) ioctl(m_device, EVIOCRMFF, m_effect);
  close(m_device);
  m_device = m_effect = -1;
}

void Rumble::use(const std::string& guid) {
  if (guid == m_guid) return;
  m_guid = guid;
  let_go();
  if (const std::optional<PadIds> ids = ids_of_guid(guid)) m_device = find_pad(*ids);
}

void Rumble::send(std::uint16_t strong, std::uint16_t weak) {
  ff_effect effect{};
  effect.type = FF_RUMBLE;
  effect.id = std::int16_t(m_effect);
  effect.replay.length = kLasts;
  effect.u.rumble.strong_magnitude = strong;
  effect.u.rumble.weak_magnitude = weak;
  if (ioctl(m_device, EVIOCSFF, &effect) < 0) return let_go();
  m_effect = effect.id;
  input_event play{};
  play.type = EV_FF;
  play.code = std::uint16_t(m_effect);
  play.value = 1;
  if (write(m_device, &play, sizeof play) != ssize_t(sizeof play)) let_go();
}

void Rumble::set(double strong, double weak, double now) {
  if (m_device < 0) return;
  const std::uint16_t s = motor_level(strong), w = motor_level(weak);
  const bool still = s == 0 && w == 0 && m_strong == 0 && m_weak == 0;
  const bool ends = s == 0 && w == 0;
  const bool changed = std::abs(s - m_strong) > kLevelStep || std::abs(w - m_weak) > kLevelStep || ends;
  if (still || now - m_sent < (changed ? kChange : kAgain)) return;
  m_strong = s;
  m_weak = w;
  m_sent = now;
  send(s, w);
}

}  // namespace trocar::app
