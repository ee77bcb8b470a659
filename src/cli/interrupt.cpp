#include "cli/interrupt.hpp"

#include <csignal>

namespace frontalis
{
namespace
{

volatile std::sig_atomic_t requested = 0;

void request(int /*signal*/) { requested = 1; }

}  // namespace

void catch_interrupts()
{
  struct sigaction action = {};
  action.sa_handler = request;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupt_requested() { return requested != 0; }

}  // namespace frontalis
