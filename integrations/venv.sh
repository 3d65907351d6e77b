# For the tests in Python, to be sourced: each has a virtual environment of its own below target/.
python=${PYTHON:-python3}

# Ends the tests where there is no Python 3.$1 or newer with venv; $2 says what is skipped.
need_python() {
    "$python" -c "import ensurepip, venv, sys; sys.exit(sys.version_info < (3, $1))" 2>/dev/null && return
    echo "skipped: $2 without Python 3.$1 or newer with venv" >&2
    exit 0
}

# Makes the environment $1 with packages; where they cannot be fetched, ends the tests with the message $2. With FETCH_ONLY, that is all.
fetch_into() {
    local env=$1 message=$2
    shift 2
    [ -x "$env/bin/python" ] || "$python" -m venv "$env"
    if "$env/bin/python" -m pip install --quiet --disable-pip-version-check "$@"; then
        [ -z "${FETCH_ONLY:-}" ] && return
        exit 0
    fi
    echo "skipped: $message" >&2
    exit 0
}
