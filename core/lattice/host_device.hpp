// Marks the functions that are compiled for both the CPU and CUDA devices.
#pragma once

#ifdef __CUDACC__
#define MENISCUS_HD __host__ __device__
#else
#define MENISCUS_HD
#endif
