#include <algorithm>

#include <trocar/devices/box/box_thread.hpp>
#include <trocar/devices/real_time.hpp>

namespace trocar::devices {
namespace {

constexpr BoxTime kSecond = 1'000'000'000;
constexpr auto kTryAgain = std::chrono::milliseconds(200);  // to open what was unplugged
constexpr BoxTime kFirstAnswer = 100'000'000;

}  // namespace

BoxDialogueSettings dialogue_settings(const BoxWiring& wiring) {
  return {wiring.baud, wiring.rate, wiring.raw, wiring.mask()};
}

BoxThread::BoxThread(const std::string& port, const BoxWiring& wiring, ChannelMask mask)
    : m_link(port, {wiring.baud, wiring.rate, wiring.raw, mask}), m_reader(wiring) {
  m_link.open();
  m_thread = std::thread([this] { loop(); });
}

BoxThread::~BoxThread() {
  m_stop.store(true);
  if (m_thread.joinable()) m_thread.join();
}

BoxStatus BoxThread::status() const {
  const std::lock_guard lock(m_lock);
  return m_status;
}

void BoxThread::loop() {
  raise_priority();
  const BoxTime period = m_link.settings().period();
  const auto each = [this](const BoxPacket& packet) { count(packet); };
  BoxTime due = m_second_began = box_now();
  while (!m_stop.load(std::memory_order_relaxed)) {
    if (!m_link.is_open() && !m_link.try_to_open()) {
      tell();
      std::this_thread::sleep_for(kTryAgain);
      due = box_now();
      continue;
    }
    m_link.ask();
    // A box that has just been switched on answers late; what is asked meanwhile would wait on a full line for ever.
    if (!m_link.answered()) m_link.listen(box_now() + kFirstAnswer, each, [this] { return m_link.answered(); });
    due = m_link.next(std::max(due + period, box_now()));  // what was slept through is not asked for afterwards
    m_link.listen(due, each);
    tell();
  }
}

void BoxThread::count(const BoxPacket& packet) {
  m_poses.put(m_reader.read(packet));
  ++m_second_blocks;
  m_longest = std::max(m_longest, packet.arrived - packet.acquired);
  m_trips.add(box_seconds(packet.arrived - packet.acquired));
  m_now.last = packet.arrived;
}

void BoxThread::tell() {
  const BoxTime now = box_now(), took = now - m_second_began;
  if (took >= kSecond || (m_first_second && took > 0)) {  // in the first one, what there is of it
    m_now.rate = double(m_second_blocks) / box_seconds(took);
    m_now.longest_trip = m_longest;
  }
  if (took >= kSecond) {
    m_now.trip_p999 = m_trips.quantile(0.999);
    m_first_second = false;
    m_second_blocks = 0;
    m_longest = 0;
    m_second_began = now;
  }
  m_now.trip_most = m_trips.longest();
  if (m_first_second) m_now.trip_p999 = m_now.trip_most;
  m_now.open = m_link.is_open();
  m_now.opened = m_link.opened();
  m_now.counts = m_link.counts();
  const std::lock_guard lock(m_lock);
  m_status = m_now;
}

}  // namespace trocar::devices
