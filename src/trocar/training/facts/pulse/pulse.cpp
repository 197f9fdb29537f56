// What a hand feels of the pulse, and how well somebody who declares with each beat has counted it.
#include <algorithm>
#include <array>

#include <trocar/sim/stages/pulse_feel.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

class FeltPulse final : public Observer {
 public:
  FeltPulse(const sim::Model& model, const Arguments& a)
      : m_reader(model), m_hand(a[0].index), m_vessel(a[1].given ? a[1].index : -1) {}
  Value value(const Snapshot& snapshot) const override {
    if (m_vessel >= 0) return m_reader.beat(snapshot.state, m_hand, m_vessel);
    double most = 0;
    for (int v = 0; v < int(snapshot.model.vessels.list.size()); ++v)
      most = std::max(most, m_reader.beat(snapshot.state, m_hand, v));
    return most;
  }

 private:
  mutable sim::PulseReader m_reader;  // its scratch
  int m_hand, m_vessel;
};

/// Times of the last declarations, as long as one follows the other.
class TappedRate final : public Observer {
 public:
  TappedRate(const sim::Model&, const Arguments&) {}
  void happened(const Snapshot& snapshot) override {
    const bool now = snapshot.state.declaring != 0;
    if (!now || m_down) return;
    m_down = true;
    if (m_count > 0 && snapshot.now() - m_time[size_t((m_count - 1) % kTaps)] > kPause) m_count = 0;
    m_time[size_t(m_count % kTaps)] = snapshot.now();
    ++m_count;
  }
  void sample(const Snapshot& snapshot, double) override { m_down = snapshot.state.declaring != 0; }
  Value value(const Snapshot& snapshot) const override {
    if (m_count < kTaps) return kUnknown;
    const double first = m_time[size_t(m_count % kTaps)], last = m_time[size_t((m_count - 1) % kTaps)];
    if (!(last > first)) return kUnknown;
    const double heart = vessels::vitals(snapshot.model.vessels.flow, snapshot.state.flow).rate / 60;
    return double(kTaps - 1) / (last - first) - heart;
  }

 private:
  static constexpr int kTaps = 6;
  static constexpr double kPause = 2.5;  // [s] after which counting restarts: slower than any heart
  std::array<double, kTaps> m_time{};    ///< [s]
  int m_count = 0;
  bool m_down = false;
};

std::string_view needs_arteries(const sim::Model& model) { return model.vessels.there() ? "" : "vessels"; }

}  // namespace

const Fact kHandPulse{"hand.pulse_N",
                      {{"hand", ArgumentKind::hand, "whose instrument"},
                       {"of", ArgumentKind::vessel, "the artery; without it the one that is felt most", false}},
                      0,
                      100,
                      "Pulse amplitude of the force with which an artery's wall pushes the instrument "
                      "through the tissue between. 0 while the instrument presses on nothing.",
                      needs_arteries,
                      &remembering<FeltPulse>};
const Fact kPulseTappedOff{"pulse.tapped_off_per_min",
                           {},
                           -1000,
                           1000,
                           "Difference between the rate of six declarations in a row and the heart rate. Unknown "
                           "before the sixth; a pause of 2.5 s restarts it.",
                           needs_arteries,
                           &remembering<TappedRate>};

}  // namespace trocar::training
