#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/serial.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/devices/box/serial_port.hpp>

namespace trocar::devices {
namespace {

struct Baud {
  int rate;
  speed_t code;
};
constexpr Baud kBauds[] = {{9600, B9600},         {19'200, B19200},      {38'400, B38400},      {57'600, B57600},
                           {115'200, B115200},    {230'400, B230400},    {460'800, B460800},    {921'600, B921600},
                           {1'000'000, B1000000}, {2'000'000, B2000000}, {3'000'000, B3000000}, {4'000'000, B4000000}};

const Baud* find_baud(int rate) {
  for (const Baud& b : kBauds)
    if (b.rate == rate) return &b;
  return nullptr;
}

/// USB adapters keep bytes back for 16 ms unless configured otherwise. Where that is impossible, they do.
void ask_for_low_latency(int fd) {
  serial_struct settings{};
  if (ioctl(fd, TIOCGSERIAL, &settings) != 0) return;
  settings.flags |= ASYNC_LOW_LATENCY;
  static_cast<void>(ioctl(fd, TIOCSSERIAL, &settings));
}

std::string remedy(const std::string& path, int error) {
  switch (error) {
    case ENOENT:
    case ENXIO:
    case ENODEV:
      return tr(
          "no port {}: plug the box in, or see with `ls /dev/ttyUSB* /dev/ttyACM* /dev/ttyS*` what it is "
          "called; `trocar box simulate {}` makes a simulated one",
          path, path);
    case EACCES:
    case EPERM:
      return tr("{} may not be opened: join the group that owns it (sudo usermod -aG dialout $USER, then log in again)",
                path);
    case EBUSY:
      return tr("{} is in use: end the other program that reads it", path);
    default:
      return tr("{}: {}: expected a serial port", path, std::strerror(error));
  }
}

}  // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  if (this != &other) {
    close();
    m_fd = std::exchange(other.m_fd, -1);
  }
  return *this;
}

void Descriptor::close() noexcept {
  if (m_fd >= 0) ::close(std::exchange(m_fd, -1));
}

bool known_baud(int baud) { return find_baud(baud) != nullptr; }

bool wait_readable(int fd, BoxTime until) {
  pollfd one{fd, POLLIN, 0};
  for (;;) {
    const BoxTime left = std::max<BoxTime>(0, until - box_now());
    const timespec time{time_t(left / 1'000'000'000), long(left % 1'000'000'000)};
    const int ready = ppoll(&one, 1, &time, nullptr);
    if (ready > 0) return true;
    if (ready == 0) return false;
    if (errno != EINTR) return true;  // reading will tell
    if (box_now() >= until) return false;
  }
}

bool make_raw(int fd, int baud) {
  termios settings{};
  if (tcgetattr(fd, &settings) != 0) return false;
  cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= tcflag_t(~(CSTOPB | CRTSCTS));
  settings.c_cc[VMIN] = 0;
  settings.c_cc[VTIME] = 0;
  if (const Baud* known = find_baud(baud)) {
    cfsetispeed(&settings, known->code);
    cfsetospeed(&settings, known->code);
  }
  return tcsetattr(fd, TCSANOW, &settings) == 0;
}

SerialPort SerialPort::open(const std::string& path, int baud) {
  SerialPort port;
  port.m_fd = Descriptor(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!port.m_fd) throw core::EnvironmentLacks(remedy(path, errno));
  const int fd = port.m_fd.get();
  if (isatty(fd) == 0) throw core::EnvironmentLacks(remedy(path, ENOTTY));
  if (ioctl(fd, TIOCEXCL) != 0 || !make_raw(fd, baud)) throw core::EnvironmentLacks(remedy(path, errno));
  ask_for_low_latency(fd);
  tcflush(fd, TCIOFLUSH);
  return port;
}

long SerialPort::read(std::span<std::uint8_t> into) {
  const ssize_t count = ::read(m_fd.get(), into.data(), into.size());
  if (count > 0) return long(count);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
  // A terminal without a byte gives 0, too; a disconnection is a hang-up.
  pollfd one{m_fd.get(), POLLIN, 0};
  if (count == 0 && poll(&one, 1, 0) >= 0 && (one.revents & (POLLHUP | POLLERR | POLLNVAL)) == 0) return 0;
  return -1;
}

bool SerialPort::write(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return true;
  const ssize_t count = ::write(m_fd.get(), bytes.data(), bytes.size());
  return count >= 0 || errno == EAGAIN || errno == EINTR;
}

}  // namespace trocar::devices
