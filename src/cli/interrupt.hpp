#pragma once

namespace frontalis
{

/// Thrown where work ends early because of Ctrl-C.
struct Interrupted
{
};

/// From now on the first Ctrl-C (or SIGTERM) only sets a flag; the second one ends the program at once.
void catch_interrupts();

bool interrupt_requested();

}  // namespace frontalis
