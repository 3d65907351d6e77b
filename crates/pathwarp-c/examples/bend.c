/* Bends a path and four points by an arc, a drawing if one is named, and shows an error.
 *
 *   cc bend.c -I../include -L../../../target/dist -lpathwarp_c -o bend && ./bend logo.svg > bent.svg
 */
#include <pathwarp.h>
#include <stdio.h>
#include <stdlib.h>

/* Prints the error, releases it, and ends the program. */
static void fail(pathwarp_status status, char *error) {
    fprintf(stderr, "error %d: %s\n", (int)status, error);
    pathwarp_string_free(error);
    exit(status);
}

static uint8_t *read_file(const char *name, size_t *length) {
    FILE *file = fopen(name, "rb");
    if (!file || fseek(file, 0, SEEK_END) != 0) return NULL;
    *length = (size_t)ftell(file);
    rewind(file);
    uint8_t *bytes = malloc(*length ? *length : 1);
    if (bytes && fread(bytes, 1, *length, file) != *length) *length = 0;
    fclose(file);
    return bytes;
}

int main(int argc, char **argv) {
    const char *names[] = {"bend"}, *values[] = {"40%"};
    pathwarp_warper *arc;
    char *error;
    pathwarp_status status = pathwarp_new("arc", names, values, 1, &arc, &error);
    if (status) fail(status, error);

    if (argc > 1) {
        size_t length, result_length;
        uint8_t *bytes = read_file(argv[1], &length), *result;
        char *report;
        if (!bytes) return 3;
        status = pathwarp_warp_drawing(arc, bytes, length, argv[1], &result, &result_length, &report, NULL, NULL, &error);
        free(bytes);
        if (status) fail(status, error);
        fwrite(result, 1, result_length, stdout);
        fprintf(stderr, "%.60s...\n", report);
        pathwarp_bytes_free(result, result_length);
        pathwarp_string_free(report);
        pathwarp_free(arc);
        return 0;
    }

    char *bent;
    double max_error;
    status = pathwarp_warp_path(arc, "M0,0 H100 V50 H0 Z", &bent, &max_error, &error);
    if (status) fail(status, error);
    printf("%s\n", bent);
    pathwarp_string_free(bent);

    double points[] = {0, 0, 100, 0, 100, 50, 0, 50};
    status = pathwarp_map_points(arc, points, points, 4, &error);
    if (status) fail(status, error);
    for (int i = 0; i < 4; i++) printf("%.17g %.17g\n", points[2 * i], points[2 * i + 1]);

    pathwarp_warper *wrong;
    status = pathwarp_new("ark", NULL, NULL, 0, &wrong, &error);
    printf("%d %s\n", (int)status, error);
    pathwarp_string_free(error);

    pathwarp_free(arc);
    return 0;
}
