// What every test executable begins with. It goes to the source folder first, so that tests name files from there
// (TROCAR_SOURCE_DIR is ".") and their objects are the same in every checkout. A case that dies, or that is still at it
// when its time is over (TROCAR_TEST_SECONDS), is named: a whole folder's cases share one process.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

namespace {

char g_running[512] = "none";

class Running : public testing::EmptyTestEventListener {
  void OnTestStart(const testing::TestInfo& info) override {
    std::snprintf(g_running, sizeof g_running, "%s.%s", info.test_suite_name(), info.name());
  }
};

/// GoogleTest's results have no words for why a case was skipped: they become a property of it (tools/test_summary.py).
class Skips : public testing::EmptyTestEventListener {
  void OnTestPartResult(const testing::TestPartResult& result) override {
    if (result.skipped()) testing::Test::RecordProperty("why", result.message());
  }
};

/// Only what a signal handler may do.
void say(const char* text) {
  std::size_t length = 0;
  while (text[length]) ++length;
  if (write(STDERR_FILENO, text, length) < 0) return;
}

void name_it_and_die(int signal) {
  say(signal == SIGALRM ? "\n[ TOO LONG ] " : "\n[  DIED  ] ");
  say(g_running);
  say("\n");
  std::signal(signal, SIG_DFL);
  raise(signal);
}

void name_what_dies() {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // those tell more themselves
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(signal, name_it_and_die);
#endif
  std::signal(SIGALRM, name_it_and_die);
  const char* seconds = std::getenv("TROCAR_TEST_SECONDS");
  if (seconds) alarm(unsigned(std::atoi(seconds)));
}

}  // namespace

int main(int argc, char** argv) {
  std::filesystem::current_path(TROCAR_CHECKOUT);  // first: parameters of cases are read when GoogleTest begins
  testing::InitGoogleTest(&argc, argv);
  testing::UnitTest::GetInstance()->listeners().Append(new Running);
  testing::UnitTest::GetInstance()->listeners().Append(new Skips);
  name_what_dies();
  return RUN_ALL_TESTS();
}
