/* pathwarp: bends points, paths and SVG drawings, and gives clean Bezier curves back.
 *
 * Everything is given as text, with the names and values of the command line: deformation "shaper", parameter "shaper", value
 * "cage.svg#flag". Texts are UTF-8 and end with a zero byte.
 *
 * Every function that can fail returns a status. On failure *error becomes a message, to be released with pathwarp_string_free, and
 * the other results stay untouched; on success *error becomes NULL. `error` itself may be NULL. Results are the caller's:
 * release them with the function named there, once. Releasing NULL does nothing.
 *
 * A warper may be used by several threads at once, except while pathwarp_set_option changes it.
 *
 * Link with -lpathwarp_c (libpathwarp_c.so or libpathwarp_c.a; the latter also needs -lm -lpthread -ldl), or with what pkg-config or
 * CMake's find_package say of `pathwarp` where install.sh has installed it.
 */
#ifndef PATHWARP_H
#define PATHWARP_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Statuses: 2 to 4 as the exit codes of the command line. */
typedef int32_t pathwarp_status;
#define PATHWARP_OK 0
#define PATHWARP_USAGE 2    /* a name or value is wrong, or a pointer is NULL */
#define PATHWARP_INPUT 3    /* a file or drawing cannot be read */
#define PATHWARP_GEOMETRY 4 /* the geometry does not allow the deformation */
#define PATHWARP_LIMIT 6    /* the work exceeds a limit */
#define PATHWARP_INTERNAL 7 /* pathwarp failed; please report it */

/* One or more deformations with their options. */
typedef struct pathwarp_warper pathwarp_warper;

/* The version of the library, such as "0.1.0". Not to be released. */
const char *pathwarp_version(void);

/* Makes a deformation, a preset such as "arc", or an edit of shapes ("simplify", "offset", "outline", "unite", "contour"), with `count`
 * parameters: names[i] has values[i]. A parameter that repeats is given several times; a switch has the value "true". Release *warper
 * with pathwarp_free. */
pathwarp_status pathwarp_new(const char *name, const char *const *names, const char *const *values, size_t count,
                             pathwarp_warper **warper, char **error);

/* Makes the deformation of the plug-in in a file, with its parameters. */
pathwarp_status pathwarp_new_plugin(const char *file, const char *const *names, const char *const *values, size_t count,
                                    pathwarp_warper **warper, char **error);

/* A function of yours: reads x and y of `count` points in turn from `from`, and writes the numbers for each in turn to `to`. Where it has
 * no image, it writes NaN. It returns 0, or another number if it failed: the call of the library then fails with PATHWARP_INPUT, and the
 * number is in its message. It may call the library. */
typedef int32_t (*pathwarp_map_fn)(void *data, const double *from, double *to, size_t count);

/* A map that is a function. What is not needed is NULL or 0. */
typedef struct pathwarp_function {
    pathwarp_map_fn points;  /* needed: x', y' */
    pathwarp_map_fn jets;    /* x', y', dx'/dx, dy'/dx, dx'/dy, dy'/dy; without it, derivatives are differences */
    pathwarp_map_fn inverse; /* x, y of the point that has this image; without it, Newton's method finds it */
    const char *creases;     /* where it has kinks, a line of text for each: "line A B C" (a x + b y + c = 0), "circle X Y R"; "edge
                              * line A B C" ends its domain where that is negative */
    double detail;           /* the size of its smallest feature, a quarter of its shortest wave; without it, curves are sampled */
    int32_t any_thread;      /* 1: it may be called by several threads at once. Otherwise only the thread that calls the library calls it */
    void *data;              /* for the functions; it lives as long as the warper and those made from it */
} pathwarp_function;

/* Makes a deformation of a function. */
pathwarp_status pathwarp_new_function(const pathwarp_function *function, pathwarp_warper **warper, char **error);

/* Makes what the text of a recipe file says. Files that it names are looked up in `folder`; "" is the current one. */
pathwarp_status pathwarp_from_recipe(const char *text, const char *folder, pathwarp_warper **warper, char **error);

/* Makes `first` followed by `second`. Both remain. */
pathwarp_status pathwarp_then(const pathwarp_warper *first, const pathwarp_warper *second, pathwarp_warper **warper,
                              char **error);

/* Makes the inverse. Before it is used, it or `of` needs the option "frame", the box of the source: percentages and defaults refer to
 * it. */
pathwarp_status pathwarp_inverse(const pathwarp_warper *of, pathwarp_warper **warper, char **error);

/* Sets an option of the command line, such as "tolerance" or "frame"; a switch has the value "true". */
pathwarp_status pathwarp_set_option(pathwarp_warper *warper, const char *name, const char *value, char **error);

/* Maps `count` points, x and y in turn, from `from` to `to`. The two may be the same, but must not overlap otherwise. Where the map
 * is undefined, the result is NaN. Percentages refer to the option "frame", or the bounding box of the points, which a single point
 * does not have. For no points, both may be NULL. */
pathwarp_status pathwarp_map_points(const pathwarp_warper *warper, const double *from, double *to, size_t count, char **error);

/* Bends SVG path data. *result is path data, within *max_error of the exact image; `max_error` may be NULL. Release *result with
 * pathwarp_string_free. */
pathwarp_status pathwarp_warp_path(const pathwarp_warper *warper, const char *data, char **result, double *max_error,
                                   char **error);

/* Warps a drawing (SVG), or a picture (PNG, JPEG, WebP), of `length` bytes. `name` is the name of its file, for messages and for linked
 * pictures beside it, which are in the result; with NULL there are none. *result is the file that the command line would write, *report
 * what was done, as JSON, and *warnings the *warning_count warnings in it; `report` and `warnings` may be NULL. Release *result with
 * pathwarp_bytes_free, *report with pathwarp_string_free, *warnings with pathwarp_strings_free. */
pathwarp_status pathwarp_warp_drawing(const pathwarp_warper *warper, const uint8_t *bytes, size_t length, const char *name,
                                      uint8_t **result, size_t *result_length, char **report, char ***warnings,
                                      size_t *warning_count, char **error);

/* Sets words as a drawing in mm whose letters are outlines. `font` is a family or a file, or NULL for the bundled Noto Sans; `size` is
 * that of the em in mm. Release *result with pathwarp_bytes_free. */
pathwarp_status pathwarp_text(const char *words, const char *font, double size, uint8_t **result, size_t *result_length,
                              char **error);

void pathwarp_free(pathwarp_warper *warper);
void pathwarp_string_free(char *text);
void pathwarp_strings_free(char **texts, size_t count);
void pathwarp_bytes_free(uint8_t *bytes, size_t length);

#ifdef __cplusplus
}
#endif

#endif
