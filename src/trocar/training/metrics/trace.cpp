#include <algorithm>
#include <cmath>

#include <trocar/core/tick.hpp>
#include <trocar/training/metrics/trace.hpp>
#include <trocar/training/metrics/trace_channels.hpp>
#include <trocar/training/observe/horizon.hpp>

namespace trocar::training {
namespace {

Vec3d vector_of(const double (&v)[3]) { return {v[0], v[1], v[2]}; }

TraceSample sample_of(const sim::Model& model, const sim::State& state, std::size_t hand) {
  const interactions::ToolState& tool = state.tools[hand];
  const kinematics::TipFrame frame = sim::tip_frame_of(model, state, hand);
  TraceSample sample;
  sample.tip = frame.tip;
  sample.orientation = quat_from_mat3(frame.rotation);
  sample.handle = tool.handle;
  sample.pinch = tool.pinch;
  sample.pull = vector_of(tool.pull);
  sample.contact = vector_of(tool.contact_force);
  return rounded(sample);
}

TraceScope traced_scope(const sim::Model& model, const sim::State& state) {
  const kinematics::ScopeFrame frame =
      kinematics::scope_frame(model.scope.port, sim::pose_of(state.scope), model.scope.angle, double(state.scope.post));
  const std::optional<double> horizon = horizon_of(model, state);
  return rounded(
      TraceScope{frame.eye, frame.forward, horizon ? *horizon * 180 / portable::pi : TraceScope::kNoHorizon});
}

/// Which mark an event makes; TraceMark::kinds: none.
TraceMark::Kind mark_of(sim::Event::Kind kind) {
  switch (kind) {
    case sim::Event::grasped:
      return TraceMark::grasped;
    case sim::Event::released:
      return TraceMark::released;
    case sim::Event::slipped:
      return TraceMark::slipped;
    case sim::Event::clipped:
      return TraceMark::clipped;
    case sim::Event::dropped_clip:
      return TraceMark::dropped;
    case sim::Event::cut:
      return TraceMark::cut;
    case sim::Event::torn:
      return TraceMark::torn;
    default:
      return TraceMark::kinds;
  }
}

}  // namespace

TraceSample rounded(const TraceSample& sample) {
  TraceSample result = sample;
  for (const auto& c : kHandChannels) c.set(result, value_of(steps_of(c.get(sample), c.scale), c.scale));
  return result;
}

TraceScope rounded(const TraceScope& scope) {
  TraceScope result = scope;
  for (const auto& c : kScopeChannels) c.set(result, value_of(steps_of(c.get(scope), c.scale), c.scale));
  return result;
}

TraceRecorder::TraceRecorder(const sim::Model& model) {
  std::vector<std::string>& names = m_trace.instruments;
  for (const sim::HandModel& hand : model.hands) {
    m_trace.hands.push_back({hand.name, true, {}});
    m_numbers.emplace_back();
    for (const interactions::ToolModel& tool : hand.rack) {
      const auto known = std::find(names.begin(), names.end(), tool.name);
      m_numbers.back().push_back(std::int32_t(known - names.begin()));
      if (known == names.end()) names.push_back(tool.name);
    }
  }
}

void TraceRecorder::update(const sim::Model& model, const sim::State& state, const sim::StepReport& report) {
  if (m_full) return;
  for (int e = 0; e < report.event_count; ++e) {
    const TraceMark::Kind kind = mark_of(report.events[e].kind);
    const std::int32_t hand = report.events[e].hand;
    if (kind == TraceMark::kinds || hand < 0) continue;
    m_marks_lost = m_marks_lost || m_trace.marks.size() == kMaxTraceMarks;
    if (!m_marks_lost) m_trace.marks.push_back({kind, hand, std::uint32_t(m_trace.size())});
  }
  if (state.tick % kTraceEvery != 0) return;
  const bool first = m_trace.size() == 0;
  m_full = m_trace.size() == kMaxTraceSamples || (!first && state.tick != m_next);
  if (m_full) return;
  if (first)
    m_trace.start = double(state.tick) /
                    double(core::kTicksPerSecond);  // not times 0.001: the double nearest to the decimal, as in CSV
  m_next = state.tick + kTraceEvery;
  for (std::size_t h = 0; h < m_trace.hands.size(); ++h) {
    m_trace.hands[h].samples.push_back(sample_of(model, state, h));
    m_trace.hands[h].samples.back().instrument = m_numbers[h][std::size_t(state.tools[h].instrument)];
  }
  m_trace.scope.push_back(traced_scope(model, state));
}

}  // namespace trocar::training
