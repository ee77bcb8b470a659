#pragma once

#include "frontalis/solver/solver.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace frontalis
{
namespace test
{

/// A test of motion that runs on every backend of this build.
class EveryBackend : public testing::TestWithParam<Backend>
{
protected:
  std::unique_ptr<Solver> solver(const Model& model, int threads = 0) const
  {
    return make_solver(std::make_shared<const Model>(model), { GetParam(), threads, 0 });
  }
  bool single_precision() const { return GetParam() != "reference"; }
};

inline std::string backend_name(const testing::TestParamInfo<Backend>& info) { return info.param; }

}  // namespace test
}  // namespace frontalis

#define FRONTALIS_EVERY_BACKEND(suite)                                                          \
  INSTANTIATE_TEST_SUITE_P(Backends, suite, testing::ValuesIn(frontalis::available_backends()), \
                           frontalis::test::backend_name)
