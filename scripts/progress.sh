# Sourced by setup, build and test: says on stderr how far a long step is. On a terminal one line is rewritten each second;
# elsewhere a line is printed each 15 seconds.
shopt -s lastpipe  # what reads a pipe keeps its variables
progress_said=$SECONDS
progress_columns=$(stty size <&2 2>/dev/null | cut -d' ' -f2 || true)

# progress TEXT; progress_end clears the line for what is to stay.
progress() {
    if [ -t 2 ]; then
        printf '\r\033[K%.*s' $((${progress_columns:-80} - 1)) "$1" >&2
    elif ((SECONDS - progress_said >= 15)); then
        progress_said=$SECONDS
        printf '%s\n' "$1" >&2
    fi
}
progress_end() { [ ! -t 2 ] || printf '\r\033[K' >&2; }

duration() { # SECONDS
    if (($1 < 100)); then echo "$1 s"; else echo "$(($1 / 60)) min$( (($1 % 60 == 0)) || echo " $(($1 % 60)) s")"; fi
}

# how_far BEGAN DONE ALL: the time since BEGAN, and by the pace until now what is left.
how_far() {
    local elapsed=$((SECONDS - $1)) left=''
    if (($2 > 0 && $2 < $3 && elapsed >= 5)); then
        left=$((elapsed * ($3 - $2) / $2))
        ((left < 100)) || left=$(((left + 30) / 60 * 60))
        left=", about $(duration $left) left"
    fi
    echo "$(duration $elapsed)$left"
}

# each_line FUNCTION: calls it with each line of stdin, and `tick` about each second, also while nothing is said.
each_line() {
    local line= part code ticked=
    while true; do
        code=0
        IFS= read -r -t 1 part || code=$?
        line+=$part
        if ((code == 0)) || { ((code <= 128)) && [ -n "$line" ]; }; then
            "$1" "$line"
            line=
        fi
        ((code == 0 || code > 128)) || return 0
        [ "$ticked" = $SECONDS ] || tick
        ticked=$SECONDS
    done
}
