// The whole way of a demonstration through the instrument box: performed, turned into what a box would measure, sent
// over the line, read, and done again without looking.
#include <gtest/gtest.h>
#include <unistd.h>

#include <trocar/attempt/box/box_playback.hpp>
#include <trocar/attempt/box/box_source.hpp>
#include <trocar/attempt/session.hpp>

#include "plugged_box.hpp"

namespace trocar::attempt {
namespace {

TEST(BoxSoak, ADemonstrationPassesThroughTheBoxAsItDoesByItself) {
  if (!devices::PseudoTerminal::possible()) GTEST_SKIP() << "/dev/ptmx is missing: no pseudo-terminals here";
  const std::unique_ptr<Lesson> lesson = load_lesson("gynaecology/sterilisation");
  const devices::BoxWiring& wiring = devices::default_wiring();
  const BoxPlayback playback(lesson->model, wiring, inputs_of_demonstration(*lesson));
  for (const auto& actor : playback.beyond())
    for (const double axis : actor) EXPECT_EQ(axis, 0) << "the built-in wiring reaches all that hands do";
  const std::string port =
      (std::filesystem::temp_directory_path() / ("trocar_box_soak_" + std::to_string(getpid()))).string();
  devices::SoftwareBoxSettings settings;
  settings.noise = 1;
  settings.drop = 0.01;
  settings.per_request = 1 / wiring.rate;
  const PluggedBox box(port, settings, [&](double seconds) { return playback.at(seconds); });
  BoxSource source(lesson->model, port, wiring, BoxPace::stepped);
  Session session(*lesson);
  sim::Input input = lesson->model.start;
  const auto ticks = std::uint64_t((playback.duration() + 2) * 1000);
  while (session.state().tick < ticks && session.broken().empty() && source.next(session.state(), input))
    session.advance(input);
  const Json result = session.result(false);
  EXPECT_TRUE(result["passed"].get<bool>()) << result["assessment"].dump(1);
  EXPECT_GE(result["assessment"]["score"]["total"].get<double>(), 95);
  EXPECT_GT(source.describe()["box"]["missed"].get<int>(), 10);
}

}  // namespace
}  // namespace trocar::attempt
