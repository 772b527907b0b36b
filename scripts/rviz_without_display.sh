# Sourced by the scripts that take pictures of rviz, after setup.sh: a ROS master's address and an X
# server of their own without a display or a graphics card, and an end of all they start.

haptex_port="$(haptex_free_port)"
export ROS_MASTER_URI="http://127.0.0.1:$haptex_port" ROS_IP=127.0.0.1
export LIBGL_ALWAYS_SOFTWARE=1 QT_X11_NO_MITSHM=1
unset ROS_HOSTNAME

haptex_work="$(mktemp -d)"
haptex_processes=()
haptex_finish() {
  for process in "${haptex_processes[@]}"; do kill -INT "$process" && wait "$process"; done || true
  rm -rf "$haptex_work"
} 2>/dev/null
trap haptex_finish EXIT

# haptex_start NAME COMMAND...: in the background, into a log of that name; ended before those that
# were started earlier.
haptex_start() {
  local log="$haptex_work/$1.log"
  shift
  "$@" >"$log" 2>&1 &
  haptex_processes=($! "${haptex_processes[@]}")
}

# haptex_end_last: ends what was started last.
haptex_end_last() {
  { kill -INT "${haptex_processes[0]}" && wait "${haptex_processes[0]}"; } 2>/dev/null || true
  haptex_processes=("${haptex_processes[@]:1}")
}

# haptex_start_display WIDTHxHEIGHT
haptex_start_display() {
  local number
  mkfifo "$haptex_work/display"
  Xvfb -displayfd 3 -noreset -screen 0 "${1}x24" 3>"$haptex_work/display" >"$haptex_work/xvfb.log" 2>&1 &
  haptex_processes=($! "${haptex_processes[@]}")
  read -r number <"$haptex_work/display"
  export DISPLAY=":$number"
}

# Waits until rviz has opened its window and drawn its first frames, which is slow without a
# graphics card.
haptex_wait_for_rviz() {
  for _ in $(seq 60); do
    xwininfo -root -tree | grep -qi rviz && break
    sleep 0.5
  done
  sleep 8
}
