// Which threads the processor serves first.
#pragma once

#include <pthread.h>

#include <string>

namespace haptex::nodes {

/// Of SCHED_FIFO, from 1 to 99: the loops before the threads that bring their messages, and these
/// before everything ordinary, such as a recorder.
constexpr int kLoopPriority = 80;
constexpr int kMessagePriority = 20;

/// Asks for SCHED_FIFO for a thread and those that it will start.
/// @returns why it was refused; empty if it was granted
std::string askForFifo(pthread_t thread, int priority);

/// In main(), before ros::init(): roscpp's threads, which bring messages and send them, come before
/// what is ordinary on a busy machine. Without the permission they are ordinary themselves.
void preferMessages();

/// Makes the calling thread an ordinary one: for what computes for long.
void beOrdinary();

}  // namespace haptex::nodes
