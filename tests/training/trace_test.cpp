// Traces: what is recorded from a State, and that bytes and text give it back or say what is wrong with them.
#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/random.hpp>
#include <trocar/training/metrics/trace.hpp>
#include <trocar/training/metrics/trace_csv.hpp>

#include "../sim/small_scene.hpp"
#include "traces.hpp"

using namespace trocar;
using namespace trocar::training;

namespace {

/// Every channel moves, jumps or rests; some numbers are negative, some large.
Trace busy_trace(std::uint64_t seed = 1) {
  core::Random random(seed);
  Trace trace = traces::make(2, 6, [&](int hand, double t) {
    TraceSample s;
    s.tip = {0.1 + 0.01 * t * t, -0.02 * t, hand == 0 ? 0.003 : random.uniform(-0.2, 0.2)};
    s.orientation = quat_from_axis_angle(Vec3d{1, 2, 3}, 0.3 * t);
    s.handle = t < 2 ? 0 : 1;
    s.pinch = t > 3 && t < 4 ? random.uniform(0, 15) : 0;
    s.pull = {0, 0, t > 3 ? -2.5 : 0};
    s.contact = {random.uniform(-1, 1), 0, 1e6};
    s.instrument = t < 3 ? -1 : hand;
    return rounded(s);
  });
  trace.start = 0.02;
  for (std::size_t i = 0; i < trace.size(); ++i)
    trace.scope.push_back(rounded(TraceScope{{0, -0.01, 0.001 * double(i)}, {0, 0.6, -0.8}}));
  trace.marks = {{TraceMark::grasped, 0, 17}, {TraceMark::cut, 1, 200}, {TraceMark::dropped, 1, 301}};
  return trace;
}

std::string message_of(const std::function<void()>& what) {
  try {
    what();
  } catch (const core::BadInput& bad) {
    return bad.what();
  }
  return "";
}

/// With the checksum made good again, so that what lies behind it is reached.
Trace read_resealed(std::vector<std::uint8_t> bytes) {
  const std::uint64_t sum = core::hash_bytes(bytes.data(), bytes.size() - 8);
  for (std::size_t i = 0; i < 8; ++i) bytes[bytes.size() - 8 + i] = std::uint8_t(sum >> (8 * i));
  return trace_from_bytes(bytes, "x");
}

}  // namespace

TEST(Trace, BytesGiveItBackExactly) {
  const Trace trace = busy_trace();
  const std::vector<std::uint8_t> bytes = to_bytes(trace);
  EXPECT_EQ(trace_from_bytes(bytes, "x"), trace);
  EXPECT_EQ(to_bytes(trace_from_bytes(bytes, "x")), bytes);
  EXPECT_LT(bytes.size(), trace.size() * 60);
  EXPECT_EQ(trace_from_bytes(to_bytes(Trace{}), "x"), Trace{});
}

TEST(Trace, CsvGivesItBackExactly) {
  const Trace trace = busy_trace();
  const std::string text = to_csv(trace);
  EXPECT_EQ(trace_from_csv(text, "x"), trace);
  EXPECT_NE(text.find("\nt_s,left.x_m,left.y_m"), std::string::npos);
  EXPECT_NE(text.find("\n# mark cut right 200\n"), std::string::npos);
}

TEST(Trace, CsvNamesThePersonAndFilesWithoutOneAreReadToo) {
  const Trace trace = busy_trace();
  const std::string text = to_csv(trace, TraceOrigin{"Ada L", "12"});
  EXPECT_EQ(text.rfind("# trocar trace 2\n# person Ada_L\n# trial 12\n", 0), 0u);
  TraceOrigin origin;
  EXPECT_EQ(trace_from_csv(text, "x", origin), trace);
  EXPECT_EQ(origin, (TraceOrigin{"Ada_L", "12"}));
  std::string old = to_csv(trace);
  old.replace(0, old.find('\n'), "# trocar trace 1");
  EXPECT_EQ(trace_from_csv(old, "x", origin), trace);
  EXPECT_EQ(origin, TraceOrigin());
  EXPECT_TRUE(is_trace_csv(old));
  EXPECT_FALSE(is_trace_csv("operator,trial,t_ms\n"));
}

TEST(Trace, StillnessCostsNextToNothing) {
  const Trace still = traces::make(3, 600, [](int, double) { return TraceSample{}; });
  EXPECT_LT(to_bytes(still).size(), 6000u);
}

TEST(Trace, WhatIsNotANumberBecomesZeroAndHugeNumbersAreBounded) {
  TraceSample s;
  s.tip = {NAN, INFINITY, -1e300};
  const TraceSample r = rounded(s);
  EXPECT_EQ(r.tip.x, 0);
  EXPECT_GT(r.tip.y, 1e6);
  EXPECT_LT(r.tip.z, -1e6);
  const Trace trace = traces::make(1, 0, [&](int, double) { return r; });
  EXPECT_EQ(trace_from_bytes(to_bytes(trace), "x"), trace);
}

TEST(Trace, EveryDamagedByteIsFound) {
  const std::vector<std::uint8_t> bytes = to_bytes(busy_trace());
  for (std::size_t i = 0; i < bytes.size(); i += i < 200 ? 1 : 97) {
    std::vector<std::uint8_t> damaged = bytes;
    damaged[i] ^= 0x10;
    EXPECT_THROW(trace_from_bytes(damaged, "x"), core::BadInput) << i;
  }
  for (std::size_t n = 0; n < bytes.size(); n += n < 200 ? 1 : 97)
    EXPECT_THROW(trace_from_bytes(std::span(bytes).first(n), "x"), core::BadInput) << n;
  EXPECT_EQ(message_of([] { trace_from_bytes({}, "attempt 7"); }), "attempt 7: byte 0: expected a motion trace");
}

TEST(Trace, HostileBytesWithAGoodChecksumAreRefusedOrSound) {
  const std::vector<std::uint8_t> bytes = to_bytes(busy_trace());
  core::Random random(2);
  int sound = 0;
  for (int round = 0; round < 3000; ++round) {
    std::vector<std::uint8_t> changed = bytes;
    const std::size_t changes = 1 + random.next() % 4;
    const std::size_t reach = round % 2 == 0 ? 150 : bytes.size();
    for (std::size_t c = 0; c < changes; ++c) changed[random.next() % reach] = std::uint8_t(random.next());
    if (round % 5 == 0) changed.resize(100 + random.next() % (bytes.size() - 100));
    try {
      const Trace trace = read_resealed(changed);
      ++sound;
      for (const TraceHand& hand : trace.hands) {
        EXPECT_EQ(hand.samples.size(), trace.size());
        for (const TraceSample& s : hand.samples) ASSERT_LT(s.instrument, std::int32_t(trace.instruments.size()));
      }
    } catch (const core::BadInput&) {
    }
  }
  EXPECT_GT(sound, 10);
}

TEST(Trace, AFewBytesCannotAskForALotOfMemory) {
  std::vector<std::uint8_t> bytes = to_bytes(traces::make(4, 0.1, [](int, double) { return TraceSample{}; }));
  // Header 28 bytes, texts of the two instruments 11 + 12, four hands 4 + 9 + 10 + 10 + 10, scope 1, marks 4.
  const std::size_t at = 99;
  ASSERT_EQ(bytes[at], 6);
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = std::uint8_t(kMaxTraceSamples >> (8 * i));
  EXPECT_EQ(message_of([&] { read_resealed(bytes); }),
            "x: byte " + std::to_string(at + 4) + ": expected more bytes for so many samples");
}

TEST(Trace, CsvFaultsAreLocated) {
  const std::string good = to_csv(traces::make(1, 0.04, [](int, double) { return TraceSample{}; }));
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return message_of([&] { trace_from_csv(text, "a.csv"); });
  };
  EXPECT_EQ(with("# trocar trace 2", "x,y"), "a.csv:1:1: expected '# trocar trace 2', got 'x,y'");
  EXPECT_EQ(message_of([] { trace_from_csv("", "a.csv"); }),
            "a.csv:1:1: expected '# trocar trace 2', got an empty file");
  EXPECT_EQ(with("left.y_m", "left.y"),
            "a.csv:6:14: expected the columns that the comments announce, 'left.y_m', got 'left.y'");
  EXPECT_EQ(with("\n0.020000,0.0000000", "\n0.020000,0x10"),
            "a.csv:8:10: expected a decimal number, not too large, got '0x10'");
  EXPECT_EQ(with("\n0.020000,0.0000000", "\n0.020000,99999999999999999999999999"),
            "a.csv:8:10: expected a decimal number, not too large, got '99999999999999999999999999'");
  EXPECT_EQ(with("\n0.040000,", "\n0.060000,"),
            "a.csv:9:1: expected the time 0.040000 s, as the rate says, got '0.060000'");
  EXPECT_EQ(with("\n0.020000,", "\n"), "a.csv:8:1: expected 17 fields, got 16");
  EXPECT_EQ(with("# rate_hz 50.000000", "# rate_hz nan").substr(0, 18), "a.csv:2:1: expecte");
}

TEST(TraceRecorder, SaysThatMarksFoundNoRoom) {
  const sim::Model& model = small::model();
  sim::State state = sim::initial_state(model);
  state.tick = 1;  // between two samples
  TraceRecorder recorder(model);
  sim::StepReport report;
  report.events[0] = sim::Event::of_hand(sim::Event::slipped, 1);
  report.event_count = 1;
  for (std::size_t i = 0; i < kMaxTraceMarks; ++i) recorder.update(model, state, report);
  EXPECT_FALSE(recorder.marks_lost());
  recorder.update(model, state, report);
  EXPECT_TRUE(recorder.marks_lost());
  EXPECT_EQ(recorder.trace().marks.size(), kMaxTraceMarks);
}

TEST(TraceRecorder, TakesFiftySamplesASecondFromTheState) {
  const sim::Model& model = small::model();
  sim::State state = sim::initial_state(model);
  TraceRecorder recorder(model);
  for (int i = 0; i < 1000; ++i) {
    ++state.tick;
    state.tools[1].depth += 0.00001;
    state.tools[1].pull[2] = 1.5;
    sim::StepReport report;
    if (i == 499) {
      report.events[0] = sim::Event::recorded(sim::Event::clipped, 1, 0, {});
      report.event_count = 1;
    }
    recorder.update(model, state, report);
  }
  const Trace& trace = recorder.trace();
  ASSERT_EQ(trace.size(), 50u);
  ASSERT_EQ(trace.hands.size(), model.hands.size());
  EXPECT_EQ(trace.scope.size(), 50u);
  EXPECT_EQ(trace.start, 0.02);
  EXPECT_EQ(trace.hands[1].name, model.hands[1].name);
  EXPECT_NEAR(length(trace.hands[1].samples[0].tip - trace.hands[1].samples[49].tip), 0.0098, 1e-6);
  EXPECT_EQ(trace.hands[1].samples[0].pull, (Vec3d{0, 0, 1.5}));
  ASSERT_EQ(trace.marks.size(), 1u);
  EXPECT_EQ(trace.marks[0], (TraceMark{TraceMark::clipped, 1, 24})) << "the sample of tick 500";
  const TraceSample& s = trace.hands[0].samples[0];
  EXPECT_EQ(trace.instruments.at(std::size_t(s.instrument)), model.tool(state, 0).name);
  EXPECT_LT(length(rotate(s.orientation, Vec3d{0, 0, -1}) -
                   kinematics::forward(model.hands[0].port, state.tools[0].pose()).axis()),
            1e-6);
  EXPECT_EQ(trace_from_bytes(to_bytes(trace), "x"), trace);
  EXPECT_EQ(trace_from_csv(to_csv(trace), "x"), trace);
}

TEST(TraceRecorder, StopsWhenATickWasLeftOutInsteadOfShiftingTime) {
  const sim::Model& model = small::model();
  sim::State state = sim::initial_state(model);
  TraceRecorder recorder(model);
  for (const std::uint64_t tick : {20u, 40u, 80u, 100u}) {
    state.tick = tick;
    recorder.update(model, state, {});
  }
  EXPECT_EQ(recorder.trace().size(), 2u);
  EXPECT_TRUE(recorder.full());
}
