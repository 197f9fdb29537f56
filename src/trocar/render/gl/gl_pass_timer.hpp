// Times what a driver does between two moments. It waits for the driver at both, so it is for measuring only.
#pragma once

#include <chrono>

#include <trocar/render/frame/pass_cost.hpp>
#include <trocar/render/gl/gl_objects.hpp>

namespace trocar::render {

class GlPassTimer {
 public:
  void start();
  PassCost stop(const char* pass);

 private:
  GlQuery m_query;  ///< GL_TIME_ELAPSED; made when it is first needed
  std::chrono::steady_clock::time_point m_wall;
  double m_processor_ms = 0;
};

}  // namespace trocar::render
