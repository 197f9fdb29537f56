#include <algorithm>
#include <cmath>

#include <trocar/interactions/instrument/tool_kind.hpp>
#include <trocar/kinematics/fulcrum.hpp>
#include <trocar/modeller/drive/test_drive.hpp>

namespace trocar::modeller {
namespace {

constexpr double kApproach = 0.12, kPull = 0.06;  ///< [m/s] as a calm hand moves
constexpr double kCloses = 0.5;                   ///< [s]

int grasping_hand(const sim::Model& model) {
  for (std::size_t h = 0; h < model.hands.size(); ++h)
    if (!model.hands[h].rack.empty() && model.hands[h].rack[0].kind == interactions::ToolKind::grasper) return int(h);
  return -1;
}

Vec3d towards(Vec3d from, Vec3d to, double most) {
  const Vec3d way = to - from;
  const double far = length(way);
  return far <= most ? to : from + way * (most / far);
}

}  // namespace

TestDrive::TestDrive(const sim::Model& model)
    : m_model(model),
      m_state(sim::initial_state(model)),
      m_work(sim::make_work(model)),
      m_input(model.start),
      m_hand(grasping_hand(model)) {
  if (m_hand < 0) return;
  m_port = model.hands[std::size_t(m_hand)].rack[0].port;
  m_tip = tip();
  m_goal = m_tip;
}

double TestDrive::blood_lost() const {
  const std::int64_t bled = m_state.fluids.ledger.in[std::size_t(fluids::Source::kBled)].blood;
  return fluids::kM3PerPicolitre * double(bled - m_model.wet.pool_at_start.blood);
}

bool TestDrive::choose(const std::string& instrument) {
  for (std::size_t h = 0; h < m_model.hands.size(); ++h) {
    const int found = m_model.hands[h].find(instrument);
    if (found < 0) continue;
    m_hand = int(h);
    m_instrument = found;
    m_port = m_model.hands[h].rack[std::size_t(found)].port;
    m_tip = tip();
    m_goal = m_tip;
    m_handle = 0;
    m_phase = m_state.tools[h].instrument == found ? Phase::rest : Phase::change;
    return true;
  }
  return false;
}

Vec3d TestDrive::tip() const {
  if (m_hand < 0) return {};
  return kinematics::forward(m_port, m_state.tools[std::size_t(m_hand)].pose()).tip;
}

bool TestDrive::holds() const { return m_hand >= 0 && m_state.tools[std::size_t(m_hand)].holds > 0; }

double TestDrive::pull() const {
  if (!holds()) return 0;
  const double* p = m_state.tools[std::size_t(m_hand)].pull;
  return std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
}

void TestDrive::take(Vec3d at) {
  // a little beyond the place along the shaft, so that the jaws close around tissue and not before it
  const Vec3d way = at - m_port;
  m_at = at + way * (0.004 / std::max(length(way), 1e-6));
  m_phase = Phase::approach;
  m_handle = 0;
  m_since = 0;
}

void TestDrive::let_go() {
  m_phase = Phase::open;
  m_since = 0;
}

bool TestDrive::done() const {
  switch (m_phase) {
    case Phase::rest:
      return true;
    case Phase::pull:
      return length(m_tip - m_goal) < 1e-6;
    default:
      return false;
  }
}

void TestDrive::tick() {
  m_since += sim::kTick;
  switch (m_phase) {
    case Phase::rest:
      break;
    case Phase::change:
      if (m_state.tools[std::size_t(m_hand)].instrument == m_instrument && m_since > 0.1) {
        m_phase = Phase::rest;
        m_tip = tip();
      }
      break;
    case Phase::approach:
      m_tip = towards(m_tip, m_at, kApproach * sim::kTick);
      if (length(m_tip - m_at) < 1e-6) m_phase = Phase::close, m_since = 0;
      break;
    case Phase::close:
      m_handle = std::min(1.0, m_handle + sim::kTick / kCloses);
      if (m_since > kCloses + 0.2) m_phase = Phase::pull, m_goal = m_tip;
      break;
    case Phase::pull:
      m_tip = towards(m_tip, m_goal, kPull * sim::kTick);
      break;
    case Phase::open:
      m_handle = std::max(0.0, m_handle - sim::kTick / kCloses);
      if (m_since > kCloses) m_tip = towards(m_tip, m_port + (m_tip - m_port) * 0.9, kPull * sim::kTick);
      if (m_since > kCloses + 0.3) m_phase = Phase::rest;
      break;
  }
  if (m_hand >= 0) {
    const double roll = m_model.start.tools[m_hand].roll;
    m_input.tools[m_hand] = sim::tool_input(kinematics::inverse(m_port, m_tip, roll), float(m_handle), m_instrument);
  }
  sim::step(m_model, m_input, m_state, m_work);
}

}  // namespace trocar::modeller
