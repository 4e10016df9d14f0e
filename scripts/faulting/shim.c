/* Preloaded into a bake: what goes wrong below a program, at a chosen moment.
 *
 * BOUCLE_FAULT=kill|full|gone at the BOUCLE_FAULT_AT-th operation on files in the folder BOUCLE_FAULT_IN: the process is killed
 * in the midst of it; from there on there is no room; from there on nothing can be read or written.
 * BOUCLE_CLOCK=jump: the time of day is another one at every look. BOUCLE_CLOCK=hurry: seconds pass a thousand times faster.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

static enum { NONE, KILL, FULL, GONE } fault = NONE;
static long at = 0, seen = 0;
static char folder[PATH_MAX];
static int jumps = 0, hurries = 0;

__attribute__((constructor)) static void begin(void) {
    const char *kind = getenv("BOUCLE_FAULT"), *clock = getenv("BOUCLE_CLOCK");
    const char *number = getenv("BOUCLE_FAULT_AT"), *place = getenv("BOUCLE_FAULT_IN");
    if (kind && number && place) {
        fault = !strcmp(kind, "kill") ? KILL : !strcmp(kind, "full") ? FULL : GONE;
        at = atol(number);
        snprintf(folder, sizeof folder, "%s/", place);
    }
    jumps = clock && !strcmp(clock, "jump");
    hurries = clock && !strcmp(clock, "hurry");
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

static int is_inside(const char *path) {
    return fault != NONE && path && !strncmp(path, folder, strlen(folder));
}

static int is_inside_fd(int fd) {
    char link[64], path[PATH_MAX];
    if (fault == NONE || fd < 3) return 0;
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    ssize_t length = readlink(link, path, sizeof path - 1);
    if (length < 0) return 0;
    path[length] = 0;
    return is_inside(path);
}

static long count(void) { return __atomic_add_fetch(&seen, 1, __ATOMIC_SEQ_CST); }

static void die(void) {
    kill(getpid(), SIGKILL);
    for (;;) pause();
}

/* Before an operation that needs no room: 1 if it must fail. */
static int fails(void) {
    if (fault == FULL) return 0;
    long number = count();
    if (fault == KILL && number == at) die();
    if (fault == GONE && number >= at) {
        errno = EIO;
        return 1;
    }
    return 0;
}

ssize_t write(int fd, const void *data, size_t size) {
    if (is_inside_fd(fd)) {
        long number = count();
        if (fault == KILL && number == at) {
            REAL(write)(fd, data, size / 2);
            die();
        }
        if (fault == GONE && number >= at) {
            errno = EIO;
            return -1;
        }
        if (fault == FULL && number == at && size > 1) return REAL(write)(fd, data, size / 2);
        if (fault == FULL && number >= at) {
            errno = ENOSPC;
            return -1;
        }
    }
    return REAL(write)(fd, data, size);
}

#define CHANGES (O_WRONLY | O_RDWR | O_CREAT | O_TRUNC)
#define OPENS(name)                                             \
    int name(const char *path, int flags, ...) {                \
        va_list rest;                                           \
        va_start(rest, flags);                                  \
        mode_t mode = va_arg(rest, mode_t);                     \
        va_end(rest);                                           \
        if ((flags & CHANGES) && is_inside(path) && fails()) return -1; \
        return REAL(name)(path, flags, mode);                   \
    }
OPENS(open)
OPENS(open64)

int rename(const char *from, const char *to) {
    if (is_inside(to) && fails()) return -1;
    return REAL(rename)(from, to);
}

int unlink(const char *path) {
    if (is_inside(path) && fails()) return -1;
    return REAL(unlink)(path);
}

int ftruncate(int fd, off_t size) {
    if (is_inside_fd(fd) && fails()) return -1;
    return REAL(ftruncate)(fd, size);
}

int ftruncate64(int fd, off64_t size) {
    if (is_inside_fd(fd) && fails()) return -1;
    return REAL(ftruncate64)(fd, size);
}

static time_t another(time_t now) {
    static unsigned long state = 88172645463325252UL;
    state ^= state << 13, state ^= state >> 7, state ^= state << 17;
    return now + (time_t)(state % 2000000000UL) - 1000000000;
}

int clock_gettime(clockid_t id, struct timespec *out) {
    int code = REAL(clock_gettime)(id, out);
    if (jumps && id == CLOCK_REALTIME) out->tv_sec = another(out->tv_sec);
    if (hurries && id == CLOCK_MONOTONIC) {
        long long nanos = (out->tv_sec % 1000000) * 1000000000LL + out->tv_nsec;
        out->tv_sec = nanos / 1000000;
        out->tv_nsec = nanos % 1000000 * 1000;
    }
    return code;
}

int gettimeofday(struct timeval *restrict out, void *restrict zone) {
    int code = REAL(gettimeofday)(out, zone);
    if (jumps) out->tv_sec = another(out->tv_sec);
    return code;
}

time_t time(time_t *out) {
    time_t now = another(REAL(time)(NULL));
    if (!jumps) now = REAL(time)(NULL);
    if (out) *out = now;
    return now;
}
