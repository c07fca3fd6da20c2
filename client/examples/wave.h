/* A fluid that needs no solver, for the examples: water in a tank, with a standing wave on it. */
#ifndef WAVE_H
#define WAVE_H

#include <math.h>

/* World units. */
#define WAVE_PARTICLE_RADIUS 0.05
/* Particles along the tank, across it and upward. */
enum { WAVE_LENGTH = 24, WAVE_WIDTH = 8, WAVE_DEPTH = 10, WAVE_PARTICLES = WAVE_LENGTH * WAVE_WIDTH * WAVE_DEPTH };

/* Fills 3 * WAVE_PARTICLES numbers: x y z of each particle; z points up. */
static inline void wave_at(double seconds, float* positions) {
    const double spacing = 2.0 * WAVE_PARTICLE_RADIUS;
    for (int i = 0; i < WAVE_PARTICLES; ++i) {
        const double x = i % WAVE_LENGTH;
        const double y = i / WAVE_LENGTH % WAVE_WIDTH;
        const double z = i / (WAVE_LENGTH * WAVE_WIDTH);
        const double rise = 1.0 + 0.3 * cos(3.0 * seconds) * cos(6.2831853 * x / (double)WAVE_LENGTH);
        positions[3 * i] = (float)(spacing * x);
        positions[3 * i + 1] = (float)(spacing * y);
        positions[3 * i + 2] = (float)(spacing * z * rise);
    }
}

/* Likewise, how fast each particle moves, world units per second. */
static inline void wave_velocity_at(double seconds, float* velocities) {
    const double spacing = 2.0 * WAVE_PARTICLE_RADIUS;
    for (int i = 0; i < WAVE_PARTICLES; ++i) {
        const double x = i % WAVE_LENGTH;
        const double z = i / (WAVE_LENGTH * WAVE_WIDTH);
        velocities[3 * i] = 0.0F;
        velocities[3 * i + 1] = 0.0F;
        velocities[3 * i + 2] =
            (float)(spacing * z * -0.9 * sin(3.0 * seconds) * cos(6.2831853 * x / (double)WAVE_LENGTH));
    }
}

#endif
