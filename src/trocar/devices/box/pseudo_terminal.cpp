#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/devices/box/pseudo_terminal.hpp>

namespace trocar::devices {

namespace fs = std::filesystem;

bool PseudoTerminal::possible() { return access("/dev/ptmx", R_OK | W_OK) == 0; }

PseudoTerminal::PseudoTerminal(const std::string& link) {
  std::error_code error;
  if (!link.empty() && fs::symlink_status(link, error).type() != fs::file_type::not_found && !fs::is_symlink(link))
    throw core::BadInput({{{link, 0, 0}, "expected a name that is free or a link, as the port of a software box"}});
  m_master = Descriptor(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  const int master = m_master.get();
  char name[128];
  if (!m_master || grantpt(master) != 0 || unlockpt(master) != 0 || ptsname_r(master, name, sizeof name) != 0)
    throw core::EnvironmentLacks(
        tr("no pseudo-terminal ({}): /dev/ptmx and /dev/pts have to be there", std::strerror(errno)));
  m_name = name;
  // Echo is on and lines are edited by default; what is set here stays as long as the master is open.
  const Descriptor slave(::open(name, O_RDWR | O_NOCTTY | O_CLOEXEC));
  if (!slave || !make_raw(slave.get(), 0))
    throw core::EnvironmentLacks(tr("{}: {}: the pseudo-terminal cannot be used", name, std::strerror(errno)));
  if (link.empty()) return;
  fs::remove(link, error);
  fs::create_symlink(m_name, link, error);
  if (error)
    throw core::EnvironmentLacks(tr("{}: {}: choose a name in a folder that may be written", link, error.message()));
  m_link = link;
}

PseudoTerminal::~PseudoTerminal() {
  std::error_code error;
  if (!m_link.empty() && fs::read_symlink(m_link, error) == fs::path(m_name)) fs::remove(m_link, error);
}

long PseudoTerminal::read(std::span<std::uint8_t> into) {
  const ssize_t count = ::read(m_master.get(), into.data(), into.size());
  if (count >= 0) return long(count);
  return errno == EIO ? -1 : 0;
}

void PseudoTerminal::write(std::span<const std::uint8_t> bytes) {
  if (!bytes.empty()) static_cast<void>(!::write(m_master.get(), bytes.data(), bytes.size()));
}

}  // namespace trocar::devices
