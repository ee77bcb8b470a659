#pragma once

namespace frontalis
{

/// Thrown where Ctrl-C ends the work early.
struct Interrupted
{
};

/// Makes the first Ctrl-C (or SIGTERM) only set a flag; the second one ends the program at once.
void catch_interrupts();

bool interrupt_requested();

}  // namespace frontalis
