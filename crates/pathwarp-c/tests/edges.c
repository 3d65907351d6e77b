/* What callers get wrong: each call says what it is about. */
#include <math.h>
#include <pathwarp.h>
#include <stdio.h>
#include <string.h>

static int failures = 0;

static void check(int ok, const char *what) {
    if (!ok) {
        failures++;
        printf("failed: %s\n", what);
    }
}

/* The status is that of wrong usage, and the message has the words. */
static void refused(pathwarp_status status, char *error, const char *words) {
    check(status == PATHWARP_USAGE && error && strstr(error, words), words);
    if (error && !strstr(error, words)) printf("  %s\n", error);
    pathwarp_string_free(error);
}

/* A shear along x by a wave, and what goes with it. `data` counts the calls. */
static int32_t wave(void *data, const double *from, double *to, size_t count) {
    (*(int *)data)++;
    for (size_t i = 0; i < count; i++) {
        to[2 * i] = from[2 * i] + 3 * sin(from[2 * i + 1] / 9);
        to[2 * i + 1] = from[2 * i + 1];
    }
    return 0;
}

static int32_t wave_jets(void *data, const double *from, double *to, size_t count) {
    (*(int *)data)++;
    for (size_t i = 0; i < count; i++) {
        double y = from[2 * i + 1];
        const double jet[] = {from[2 * i] + 3 * sin(y / 9), y, 1, 0, cos(y / 9) / 3, 1};
        memcpy(to + 6 * i, jet, sizeof jet);
    }
    return 0;
}

static int32_t wave_back(void *data, const double *from, double *to, size_t count) {
    (*(int *)data)++;
    for (size_t i = 0; i < count; i++) {
        to[2 * i] = from[2 * i] - 3 * sin(from[2 * i + 1] / 9);
        to[2 * i + 1] = from[2 * i + 1];
    }
    return 0;
}

static int32_t fails(void *data, const double *from, double *to, size_t count) {
    (void)data, (void)from, (void)to, (void)count;
    return 17;
}

/* Bends with the library from within a function. */
static int32_t nested(void *data, const double *from, double *to, size_t count) {
    return pathwarp_map_points(data, from, to, count, NULL);
}

/* Functions as maps: their values, ends of curves, inverses, chains, failures, and which thread calls them. */
static void functions(const char *page) {
    char *error, *bent;
    pathwarp_status status;
    int calls = 0;
    pathwarp_warper *map, *back, *both;
    const pathwarp_function whole = {wave, wave_jets, wave_back, NULL, 14, 0, &calls}, plain = {.points = wave, .data = &calls};
    const pathwarp_function *kinds[] = {&whole, &plain};
    for (int k = 0; k < 2; k++) {
        check(!pathwarp_new_function(kinds[k], &map, &error), "a function");
        double points[] = {10, 20, 60, 50, 30, 30}, images[6], again[6];
        check(!pathwarp_map_points(map, points, images, 3, &error), "points of a function");
        for (int i = 0; i < 3; i++) check(images[2 * i] == points[2 * i] + 3 * sin(points[2 * i + 1] / 9), "values of a function");
        double x, y;
        check(!pathwarp_warp_path(map, "M5,9 L20,80", &bent, NULL, &error), "a path under a function");
        check(sscanf(bent, "M%lf,%lf", &x, &y) == 2 && fabs(x - 5 - 3 * sin(1)) < 1e-3 && fabs(y - 9) < 1e-3, "the start of the path");
        pathwarp_string_free(bent);
        check(!pathwarp_inverse(map, &back, &error) && !pathwarp_set_option(back, "frame", "0,0,100,100", &error), "its inverse");
        check(!pathwarp_map_points(back, images, again, 3, &error), "back by a function");
        for (int i = 0; i < 6; i++) check(fabs(again[i] - points[i]) < 1e-9, "the inverse of a function undoes");
        check(!pathwarp_then(map, map, &both, &error) && !pathwarp_map_points(both, points, images, 3, &error), "twice");
        for (int i = 0; i < 3; i++) check(fabs(images[2 * i] - points[2 * i] - 6 * sin(points[2 * i + 1] / 9)) < 1e-12, "two functions");
        uint8_t *result;
        size_t length, count;
        char **warnings;
        check(!pathwarp_warp_drawing(both, (const uint8_t *)page, strlen(page), "a.svg", &result, &length, NULL, &warnings, &count, &error), "a drawing");
        pathwarp_bytes_free(result, length), pathwarp_strings_free(warnings, count);
        pathwarp_free(both), pathwarp_free(back), pathwarp_free(map);
    }
    check(calls > 10, "functions were called");
    const pathwarp_function failing = {.points = fails}, none = {.points = NULL}, creased = {.points = wave, .creases = "line 1 2"};
    check(!pathwarp_new_function(&failing, &map, &error), "a function that fails");
    double at[] = {1, 2, 3, 4}, to[] = {7, 7, 7, 7};
    check(pathwarp_map_points(map, at, to, 2, &error) == PATHWARP_INPUT && strstr(error, "function.points: failed with 17"), "its failure");
    check(to[0] == 7 && to[3] == 7, "a failed call leaves its results");
    pathwarp_string_free(error);
    check(pathwarp_warp_path(map, "M0,0 H9", &bent, NULL, &error) == PATHWARP_INPUT && strstr(error, "failed with 17"), "its failure on a path");
    pathwarp_string_free(error), pathwarp_free(map);
    status = pathwarp_new_function(NULL, &map, &error);
    refused(status, error, "function is NULL");
    status = pathwarp_new_function(&none, &map, &error);
    refused(status, error, "function.points is NULL");
    status = pathwarp_new_function(&creased, &map, &error);
    refused(status, error, "line A B C");

    pathwarp_warper *inner;
    check(!pathwarp_new("swirl", NULL, NULL, 0, &inner, &error) && !pathwarp_set_option(inner, "frame", "0,0,9,9", &error), "inner");
    const pathwarp_function within = {.points = nested, .data = inner};
    check(!pathwarp_new_function(&within, &map, &error) && !pathwarp_warp_path(map, "M1,1 H8", &bent, NULL, &error), "a call within a call");
    pathwarp_string_free(bent), pathwarp_free(map), pathwarp_free(inner);
}

/* Edits, words, and names of presets in recipes. */
static void others(void) {
    char *error, *bent, *same;
    const char *names[] = {"by"}, *values[] = {"2"};
    pathwarp_warper *edit, *arc, *preset;
    uint8_t *result;
    size_t length;
    check(!pathwarp_new("offset", names, values, 1, &edit, &error), "an edit");
    check(!pathwarp_warp_path(edit, "M0,0 H9 V9 H0 Z", &bent, NULL, &error) && strpbrk(bent, "AC"), "round corners");
    pathwarp_string_free(bent), pathwarp_free(edit);
    check(!pathwarp_text("Word", NULL, 20, &result, &length, &error) && length > 500, "words");
    check(!memcmp(result, "<svg", 4), "words are a drawing");
    pathwarp_bytes_free(result, length);
    check(pathwarp_text("Word", "no such family", 20, &result, &length, &error) == PATHWARP_USAGE, "an unknown font");
    pathwarp_string_free(error);
    check(!pathwarp_from_recipe("pathwarp = 1\n[[step]]\ndeformation = \"arc\"\n", "", &preset, &error), "a preset in a recipe");
    check(!pathwarp_new("arc", NULL, NULL, 0, &arc, &error), "arc");
    check(!pathwarp_warp_path(preset, "M0,0 H9 V9", &bent, NULL, &error) && !pathwarp_warp_path(arc, "M0,0 H9 V9", &same, NULL, &error), "both");
    check(!strcmp(bent, same), "a preset in a recipe is that preset");
    pathwarp_string_free(bent), pathwarp_string_free(same), pathwarp_free(arc), pathwarp_free(preset);
    check(pathwarp_new_plugin("/no/such/plug-in", NULL, NULL, 0, &edit, &error) == PATHWARP_INPUT && strstr(error, "is not a file"), "no plug-in");
    pathwarp_string_free(error);
}

int main(void) {
    char *error, *bent;
    pathwarp_status status;
    pathwarp_warper *swirl, *back;
    check(!pathwarp_new("swirl", NULL, NULL, 0, &swirl, &error), "swirl");

    /* An inverse without a frame. */
    double points[] = {10, 20, 60, 50, 30, 30}, images[6], again[6];
    check(!pathwarp_inverse(swirl, &back, &error), "inverse");
    const char *unknown = "an inverse does not know the box of the source";
    status = pathwarp_map_points(back, points, images, 3, &error);
    refused(status, error, unknown);
    status = pathwarp_warp_path(back, "M0,0 H9", &bent, NULL, &error);
    refused(status, error, unknown);
    const char *page = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><path d='M0,0H9V9z'/></svg>";
    uint8_t *result;
    size_t length;
    status = pathwarp_warp_drawing(back, (const uint8_t *)page, strlen(page), NULL, &result, &length, NULL, NULL, NULL, &error);
    refused(status, error, unknown);
    check(!pathwarp_set_option(swirl, "frame", "0,0,100,100", &error), "frame");
    check(!pathwarp_set_option(back, "frame", "0,0,100,100", &error), "frame after inverse");
    check(!pathwarp_map_points(swirl, points, images, 3, &error), "forth");
    check(!pathwarp_map_points(back, images, again, 3, &error), "back");
    for (int i = 0; i < 6; i++) check(fabs(again[i] - points[i]) < 1e-9, "the inverse undoes");
    pathwarp_free(back);

    /* No points and one point without a frame. */
    pathwarp_warper *plain;
    check(!pathwarp_new("swirl", NULL, NULL, 0, &plain, &error), "plain");
    check(!pathwarp_map_points(plain, NULL, NULL, 0, &error) && !error, "no points");
    status = pathwarp_map_points(plain, points, images, 1, &error);
    refused(status, error, "the box of the points has no size, which percentages and defaults refer to: give it (frame X,Y,W,H)");
    check(!pathwarp_map_points(swirl, points, images, 1, &error), "one point in a frame");

    /* Tolerances that no curve can keep, or every curve does. */
    const char *wrong[] = {"0", "-1", "nan", "inf", "-0", ""};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        status = pathwarp_set_option(plain, "tolerance", wrong[i], &error);
        refused(status, error, "tolerance: ");
    }

    pathwarp_free(plain);
    pathwarp_free(swirl);
    functions(page);
    others();
    return failures != 0;
}
