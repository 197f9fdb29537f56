#include <algorithm>
#include <thread>

#include <trocar/devices/box/serving.hpp>
#include <trocar/devices/real_time.hpp>

namespace trocar::devices {
namespace {

constexpr BoxTime kPortion = 2'000'000;  // bytes leave in portions of that long, the last of a block on time
constexpr BoxTime kIdle = 20'000'000;

}  // namespace

void serve(SoftwareBox& box, PseudoTerminal& terminal, const std::function<bool()>& stop,
           const std::function<void(PortReader)>& changed) {
  raise_priority();
  std::array<std::uint8_t, 256> in, out;
  PortReader reader = PortReader::none;
  const auto note = [&](PortReader now) {
    if (now != reader && changed) changed(now);
    reader = now;
  };
  while (!stop()) {
    const long count = terminal.read(in);
    if (count < 0) {  // nobody is there; waiting for bytes would return at once
      if (reader != PortReader::none) box.hang_up();
      note(PortReader::none);
      std::this_thread::sleep_for(std::chrono::nanoseconds(kIdle));
      continue;
    }
    note(box.waits(box_now()) && count == 0 ? PortReader::stopped : PortReader::asks);
    if (count > 0) box.hear(std::span(in).first(std::size_t(count)), box_now());
    terminal.write(std::span(out).first(box.due(box_now(), out)));
    const BoxTime now = box_now(), next = box.next_due();
    const BoxTime until = next == SoftwareBox::kNever ? now + kIdle : std::min(next, now + kPortion);
    if (count <= 0) terminal.wait(until);
  }
}

}  // namespace trocar::devices
