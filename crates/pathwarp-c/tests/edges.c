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
    status = pathwarp_warp_drawing(back, (const uint8_t *)page, strlen(page), &result, &length, NULL, &error);
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
    return failures != 0;
}
