#include <ctime>

#include <trocar/render/gl/gl_pass_timer.hpp>

namespace trocar::render {
namespace {

using Clock = std::chrono::steady_clock;

/// Of all threads of this process [ms].
double processor_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * double(t.tv_sec) + 1e-6 * double(t.tv_nsec);
}

}  // namespace

void GlPassTimer::start() {
  if (!m_query) m_query = new_query();
  glFinish();
  m_wall = Clock::now();
  m_processor_ms = processor_ms();
  glBeginQuery(GL_TIME_ELAPSED, m_query.id());
}

PassCost GlPassTimer::stop(const char* pass) {
  glEndQuery(GL_TIME_ELAPSED);
  glFinish();
  PassCost cost{pass, std::chrono::duration<double, std::milli>(Clock::now() - m_wall).count(),
                processor_ms() - m_processor_ms, 0};
  GLint bits = 0;
  glGetQueryiv(GL_TIME_ELAPSED, GL_QUERY_COUNTER_BITS, &bits);
  if (bits == 0) return cost;
  GLuint64 nanoseconds = 0;
  glGetQueryObjectui64v(m_query.id(), GL_QUERY_RESULT, &nanoseconds);
  cost.gpu_ms = 1e-6 * double(nanoseconds);
  return cost;
}

}  // namespace trocar::render
