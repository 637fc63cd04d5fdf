# Functions of scripts/run and scripts/test that check for required software and install it.
# On macOS and Windows only Rust is needed; the package checks do nothing there.

say() { printf '%s\n' "$*" >&2; }
stop() { say "$@"; exit 1; }

# Needed to build: a linker and the headers of the C library.
BUILD_PACKAGES="gcc libc6-dev"
# Needed to open a window. The drivers include a software renderer for machines without a GPU.
WINDOW_PACKAGES="libx11-6 libx11-xcb1 libxcb1 libxcursor1 libxi6 libxrandr2 \
libxkbcommon0 libxkbcommon-x11-0 libwayland-client0 libvulkan1 mesa-vulkan-drivers"
# Needed to test the window without a display.
DISPLAY_PACKAGES="xvfb xauth xdotool"

# require_rust [COMPONENT...]: checks for a recent enough Rust and installs missing components.
require_rust() {
    if ! command -v cargo >/dev/null && [ -r "$HOME/.cargo/env" ]; then
        . "$HOME/.cargo/env"
    fi
    wanted=$(sed -n 's/^rust-version = "\(.*\)"$/\1/p' Cargo.toml)
    command -v cargo >/dev/null && command -v rustc >/dev/null ||
        stop "Rust is missing: install Rust $wanted or newer with rustup, then run this script again."
    found=$(rustc --version | awk '{ print $2 }')
    printf '%s %s\n' "$found" "$wanted" | awk '{
        split($1, f, "."); split($2, w, ".")
        exit !(f[1] + 0 > w[1] + 0 || (f[1] == w[1] && f[2] + 0 >= w[2] + 0))
    }' || stop "Rust $found is too old: Morphospace needs $wanted or newer. Run: rustup update stable"
    for component in "$@"; do
        cargo "${component#rust}" --version >/dev/null 2>&1 ||
            { command -v rustup >/dev/null && rustup component add "$component" >&2; } ||
            stop "Rust's $component is missing. Run: rustup component add $component"
    done
}

# find_players: installs the players of Lottie files with which tests/motion compares, if Python and
# npm are there. The tests say which player is missing, so a failure is not an error.
find_players() {
    players="${XDG_CACHE_HOME:-$HOME/.cache}/morphospace/players"
    mkdir -p "$players"
    if [ -z "${MORPHOSPACE_PYTHON:-}" ] && [ ! -x "$players/python/bin/pip" ]; then
        python3 -m venv "$players/python" >/dev/null 2>&1 || rm -rf "$players/python"
    fi
    if [ -z "${MORPHOSPACE_PYTHON:-}" ] && [ -x "$players/python/bin/pip" ]; then
        timeout 60 "$players/python/bin/pip" install -q pillow rlottie-python thorvg-python >&2 ||
            say "The Lottie players of PyPI could not be installed."
        export MORPHOSPACE_PYTHON="$players/python/bin/python"
    fi
    script="$players/package/build/player/lottie.min.js"
    if [ -z "${MORPHOSPACE_LOTTIE:-}" ] && [ ! -r "$script" ] && command -v npm >/dev/null; then
        (cd "$players" && timeout 60 npm pack --silent lottie-web@5 >/dev/null &&
            tar -xzf lottie-web-*.tgz) >&2 || say "lottie-web could not be installed."
    fi
    if [ -z "${MORPHOSPACE_LOTTIE:-}" ] && [ -r "$script" ]; then
        export MORPHOSPACE_LOTTIE="$script"
    fi
}

# require_packages PACKAGE...: checks for Debian packages and installs missing ones if permitted.
require_packages() {
    [ "$(uname -s)" = Linux ] || return 0
    if ! command -v dpkg-query >/dev/null; then
        say "Not a Debian or Ubuntu machine: not checking for $*"
        return 0
    fi
    missing=""
    for package in "$@"; do
        dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -q '^installed' ||
            missing="$missing $package"
    done
    [ -n "$missing" ] || return 0
    if [ "$(id -u)" -eq 0 ]; then
        as_root="env"
    elif command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
        as_root="sudo -n env"
    else
        stop "Packages are missing. Install them, then run this script again:" \
            "sudo apt-get install$missing"
    fi
    say "Installing:$missing"
    { $as_root apt-get -q update &&
        $as_root DEBIAN_FRONTEND=noninteractive apt-get -q install -y --no-install-recommends $missing
    } >&2 || stop "Installation failed. Install these packages yourself:$missing"
}
