#include "frontalis/solver/backend.hpp"

#include "block_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <string>

using namespace frontalis;

TEST(Backend, NamesBeginWithAuto)
{
  const std::vector<Backend> names = backend_names(), available = available_backends();
  ASSERT_EQ(names.size(), 1 + registered_backends().size());
  EXPECT_EQ(names.front(), "auto");
  for (std::size_t i = 1; i < names.size(); ++i)
    EXPECT_EQ(names[i], registered_backends()[i - 1].name);
  for (const Backend& name : { Backend("cpu"), Backend("reference") })
    EXPECT_EQ(std::count(available.begin(), available.end(), name), 1) << name;
}

TEST(Backend, AnUnknownNameIsRefusedWithThoseThatThereAre)
{
  const auto model = std::make_shared<const Model>(test::block_model({}));
  try
  {
    make_solver(model, { "abacus" });
    FAIL();
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("abacus"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("auto, "), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("cpu, reference"), std::string::npos);
  }
}

// On a machine with a GPU, the fallback to the CPU is caused by a model that the GPU does not accept.
TEST(Fallback, FromTheGpuIsToldOnce)
{
  Model model = test::block_model({});
  model.muscles.resize(1000);
  const auto shared = std::make_shared<const Model>(model);
  testing::internal::CaptureStderr();
  const auto first = make_solver(shared), second = make_solver(shared);
  const std::string output = testing::internal::GetCapturedStderr();
  for (const auto* solver : { first.get(), second.get() })
    EXPECT_EQ(solver->description().substr(0, 3), "cpu");
  if (registered_backends().front().name == "cpu")
  {
    EXPECT_EQ(output, "");
    return;
  }
  EXPECT_EQ(output.find("warning: backend cpu is used (backend cuda: "), 0u) << output;
  EXPECT_EQ(std::count(output.begin(), output.end(), '\n'), 1) << output;
  EXPECT_NE(second->description().find("backend cuda: "), std::string::npos) << second->description();
}

// Diagnostics show the description of a solver. That of the GPU backend names the device, and says whether the model is
// cut into patches or strips.
TEST(Description, NamesTheDevice)
{
  const auto model = std::make_shared<const Model>(test::block_model({}));
  for (const Backend& backend : available_backends())
  {
    const std::string words = make_solver(model, { backend, 1 })->description();
    const std::string device = backend == "cuda"  ? "cuda \\(float, .+, [0-9]+ (patches|strips, [0-9]+ % filled)\\)"
                               : backend == "cpu" ? "cpu \\((float|double), .+, 1 thread\\)"
                                                  : "reference.*";
    EXPECT_TRUE(std::regex_match(words, std::regex(device))) << words;
  }
}
