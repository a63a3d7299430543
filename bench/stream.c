// c = a + 3 b over arrays of float32 (STREAM's triad): what memory allows. With `past` the results go past the caches,
// so that their lines are not read first; the arrays start at borders of cache lines and hold a multiple of 16 values.
#include <stddef.h>

#ifdef __x86_64__
#include <immintrin.h>

__attribute__((target("avx2,fma"))) void triad(const float *a, const float *b, float *c, size_t n, int past)
{
    const __m256 three = _mm256_set1_ps(3.0f);
    for (size_t i = 0; i < n; i += 8) {
        __m256 sum = _mm256_fmadd_ps(three, _mm256_load_ps(b + i), _mm256_load_ps(a + i));
        if (past)
            _mm256_stream_ps(c + i, sum);
        else
            _mm256_store_ps(c + i, sum);
    }
    _mm_sfence();
}
#else
void triad(const float *a, const float *b, float *c, size_t n, int past)
{
    (void)past;
    for (size_t i = 0; i < n; i++)
        c[i] = a[i] + 3.0f * b[i];
}
#endif
