// Which threads the processor serves first.
#pragma once

#include <pthread.h>

#include <string>

namespace haptex::nodes {

/// Of SCHED_FIFO, from 1 to 99: the loops.
constexpr int kLoopPriority = 80;
/// Of the threads that bring messages and send them: before everything ordinary, such as a
/// recorder. Not SCHED_FIFO, because the kernel holds all of that up for 50 ms when it takes 95 %
/// of a core.
constexpr int kMessageNiceness = -15;

/// Asks for SCHED_FIFO for a thread.
/// @returns why it was refused; empty if it was granted
std::string askForFifo(pthread_t thread, int priority);

/// In main(), before ros::init(): roscpp's threads, which bring messages and send them, come before
/// what is ordinary on a busy machine. Without the permission they are ordinary themselves.
void preferMessages();

/// Makes the calling thread an ordinary one: for what computes for long.
void beOrdinary();

}  // namespace haptex::nodes
