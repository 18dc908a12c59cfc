# shellcheck shell=bash disable=SC2154 # the script that reads this file sets limit and ranks
# The body of both job scripts, bed.slurm and bed.mpirun: the part of a bed's run that one job computes, from
# its start or from where the previous job has stopped. Copy the three files into the folder of your results,
# set the following values here or in the environment, and submit one of the two.

# The deck: or bed/in.bed.lammps, in.bed3d, a deck of one's own that includes in.bed.
deck=${deck:-bed/in.bed}
start=${start:-results/bed/roller.restart}    # from in.place
out=${out:-results/bed/B}
# Variables of the deck, further ones, too; the same in every job.
variables=(-var transition B -var cycles "${cycles:-10}")
drumlin=${drumlin:-drumlin}                   # the installed one, or the path of ./drumlin in a checkout

stopped=4 # exit status of a job after which another is needed

# Runs the deck for at most $limit seconds of wall time, at least one cycle, on $ranks ranks. 0: all cycles
# are done; $stopped: they are not, and the next job continues from $out/stopped.restart; else the run has
# failed.
run_piece() {
  local from=$start screen=$out/screen.txt
  mkdir -p -- "$out" || return
  if [ -f "$out/finished" ]; then
    echo "all cycles are done: $out"
    return 0
  fi
  [ ! -f "$out/stopped.restart" ] || from=$out/stopped.restart
  "$drumlin" run -np "$ranks" "$deck" -var start "$from" -var out "$out" -var time_limit "$limit" \
    "${variables[@]}" >"$screen" 2>&1 ||
    { grep -m1 ERROR "$screen" >&2 || tail -n 3 "$screen" >&2; return 1; }
  grep '^drumlin/run:' "$screen" | tail -n 1
  grep -q '^drumlin/run: 100 %' "$screen" || return "$stopped"
  touch -- "$out/finished"
}
