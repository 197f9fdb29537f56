#include <algorithm>
#include <thread>

#include <trocar/devices/box/serving.hpp>

namespace trocar::devices {
namespace {

constexpr BoxTime kPortion = 2'000'000;  // bytes leave in portions of that long, the last of a block on time
constexpr BoxTime kIdle = 20'000'000;

}  // namespace

void serve(SoftwareBox& box, PseudoTerminal& terminal, const std::function<bool()>& stop) {
  std::array<std::uint8_t, 256> in, out;
  bool there = false;
  while (!stop()) {
    const long count = terminal.read(in);
    if (count < 0) {  // nobody is there; waiting for bytes would return at once
      if (there) box.hang_up();
      there = false;
      std::this_thread::sleep_for(std::chrono::nanoseconds(kIdle));
      continue;
    }
    there = true;
    if (count > 0) box.hear(std::span(in).first(std::size_t(count)), box_now());
    terminal.write(std::span(out).first(box.due(box_now(), out)));
    const BoxTime now = box_now(), next = box.next_due();
    const BoxTime until = next == SoftwareBox::kNever ? now + kIdle : std::min(next, now + kPortion);
    if (count <= 0) terminal.wait(until);
  }
}

}  // namespace trocar::devices
