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

/* Makes a deformation, or a preset such as "arc", with `count` parameters: names[i] has values[i]. A parameter that repeats is
 * given several times; a switch has the value "true". Release *warper with pathwarp_free. */
pathwarp_status pathwarp_new(const char *name, const char *const *names, const char *const *values, size_t count,
                             pathwarp_warper **warper, char **error);

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

/* Warps a drawing (SVG), or a picture (PNG, JPEG, WebP), of `length` bytes. *result is the file that the command line would write,
 * *report what was done, as JSON; `report` may be NULL. Release *result with pathwarp_bytes_free, *report with
 * pathwarp_string_free. */
pathwarp_status pathwarp_warp_drawing(const pathwarp_warper *warper, const uint8_t *bytes, size_t length, uint8_t **result,
                                      size_t *result_length, char **report, char **error);

void pathwarp_free(pathwarp_warper *warper);
void pathwarp_string_free(char *text);
void pathwarp_bytes_free(uint8_t *bytes, size_t length);

#ifdef __cplusplus
}
#endif

#endif
