/* Calls on files below a folder that fail on demand: a library that is loaded before the one of the system.
 *
 * FAULT_FOLDER is the folder. With FAULT_COUNTS the numbers of calls are written to that file at the end of the program;
 * with FAULT="call number error" one call fails: the error is a number of errno.h, or 0 for half of a write. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

enum call { OPEN, WRITE, RENAME, SYNC, LOCK, TRUNCATE, LINK, REMOVE, MKDIR, CALLS };
static const char *const names[CALLS] = {"open", "write", "rename", "sync", "lock", "truncate", "link", "remove", "mkdir"};
static int counts[CALLS];

/* 1 where a call below the folder is to fail, with errno; -1 where half of it is to be done. */
static int fails_at(enum call call, const char *path)
{
    const char *folder = getenv("FAULT_FOLDER");
    if (!folder || strncmp(path, folder, strlen(folder)) != 0)
        return 0;
    int number = __atomic_add_fetch(&counts[call], 1, __ATOMIC_SEQ_CST);
    const char *fault = getenv("FAULT");
    char name[16];
    int wanted, error;
    if (!fault || sscanf(fault, "%15s %d %d", name, &wanted, &error) != 3)
        return 0;
    if (number != wanted || strcmp(name, names[call]) != 0)
        return 0;
    errno = error;
    return error ? 1 : -1;
}

static int fails(enum call call, int file)
{
    char link[64], path[PATH_MAX];
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    ssize_t length = readlink(link, path, sizeof path - 1);
    if (length < 0)
        return 0;
    path[length] = 0;
    return fails_at(call, path);
}

__attribute__((destructor)) static void report(void)
{
    const char *path = getenv("FAULT_COUNTS");
    FILE *file = path ? fopen(path, "w") : NULL;
    if (!file)
        return;
    for (int call = 0; call < CALLS; call++)
        fprintf(file, "%s %d\n", names[call], counts[call]);
    fclose(file);
}

#define REAL(type, name, ...) type (*real)(__VA_ARGS__) = dlsym(RTLD_NEXT, #name)

#define OPENS(name)                                                 \
    int name(const char *path, int flags, ...)                      \
    {                                                               \
        REAL(int, name, const char *, int, ...);                    \
        va_list more;                                               \
        va_start(more, flags);                                      \
        mode_t mode = flags & O_CREAT ? va_arg(more, mode_t) : 0;   \
        va_end(more);                                               \
        return fails_at(OPEN, path) > 0 ? -1 : real(path, flags, mode); \
    }
OPENS(open)
OPENS(open64)

ssize_t write(int file, const void *bytes, size_t size)
{
    REAL(ssize_t, write, int, const void *, size_t);
    int fault = fails(WRITE, file);
    return fault > 0 ? -1 : real(file, bytes, fault < 0 && size > 1 ? size / 2 : size);
}

int rename(const char *from, const char *to)
{
    REAL(int, rename, const char *, const char *);
    return fails_at(RENAME, to) > 0 ? -1 : real(from, to);
}

int fsync(int file)
{
    REAL(int, fsync, int);
    return fails(SYNC, file) > 0 ? -1 : real(file);
}

int fdatasync(int file)
{
    REAL(int, fdatasync, int);
    return fails(SYNC, file) > 0 ? -1 : real(file);
}

int flock(int file, int operation)
{
    REAL(int, flock, int, int);
    return fails(LOCK, file) > 0 ? -1 : real(file, operation);
}

int ftruncate64(int file, off64_t size)
{
    REAL(int, ftruncate64, int, off64_t);
    return fails(TRUNCATE, file) > 0 ? -1 : real(file, size);
}

int linkat(int from_folder, const char *from, int to_folder, const char *to, int flags)
{
    REAL(int, linkat, int, const char *, int, const char *, int);
    return fails_at(LINK, to) > 0 ? -1 : real(from_folder, from, to_folder, to, flags);
}

int unlink(const char *path)
{
    REAL(int, unlink, const char *);
    return fails_at(REMOVE, path) > 0 ? -1 : real(path);
}

int rmdir(const char *path)
{
    REAL(int, rmdir, const char *);
    return fails_at(REMOVE, path) > 0 ? -1 : real(path);
}

int mkdir(const char *path, mode_t mode)
{
    REAL(int, mkdir, const char *, mode_t);
    return fails_at(MKDIR, path) > 0 ? -1 : real(path, mode);
}
