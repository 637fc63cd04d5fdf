#!/usr/bin/env bash
# Times the simplicial back-substitution of CHOLMOD with two right-hand sides and reused memory.
#
#   film_cholmod.sh MATRIX RUNS    MATRIX is a file in Matrix Market format
#
# Prints the median time of RUNS runs in milliseconds. Needs gcc and the headers of SuiteSparse
# (Debian: gcc libsuitesparse-dev).
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/solve.c" <<'C'
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <suitesparse/cholmod.h>

static int by_size(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int main(int argc, char **argv) {
    cholmod_common c;
    cholmod_start(&c);
    c.supernodal = CHOLMOD_SIMPLICIAL;
    FILE *file = argc == 3 ? fopen(argv[1], "r") : NULL;
    if (!file) return 2;
    cholmod_sparse *a = cholmod_read_sparse(file, &c);
    cholmod_factor *l = cholmod_analyze(a, &c);
    cholmod_factorize(a, l, &c);
    if (c.status != CHOLMOD_OK) return 1;
    cholmod_dense *b = cholmod_ones(a->nrow, 2, CHOLMOD_REAL, &c);
    cholmod_dense *x = NULL, *y = NULL, *e = NULL;
    int times = atoi(argv[2]);
    double *ms = malloc(times * sizeof *ms);
    for (int i = -1; i < times; i++) {
        struct timespec from, to;
        clock_gettime(CLOCK_MONOTONIC, &from);
        cholmod_solve2(CHOLMOD_A, l, b, NULL, &x, NULL, &y, &e, &c);
        clock_gettime(CLOCK_MONOTONIC, &to);
        if (i >= 0) ms[i] = (to.tv_sec - from.tv_sec) * 1e3 + (to.tv_nsec - from.tv_nsec) * 1e-6;
    }
    qsort(ms, times, sizeof *ms, by_size);
    printf("%.4f\n", ms[times / 2]);
    return 0;
}
C
gcc -O3 -o "$folder/solve" "$folder/solve.c" -lcholmod
"$folder/solve" "$1" "$2"
