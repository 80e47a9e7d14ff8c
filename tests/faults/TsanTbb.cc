/// @file TsanTbb.cc
/// Tells the thread sanitizer what TBB does.
///
/// TBB as packaged is not instrumented, so the sanitizer sees neither that a task comes from the thread that
/// spawned it, nor that a loop waits for its tasks (https://github.com/google/sanitizers/issues/1004). This
/// executable has its own entry points of TBB, which say so and go on to the library's.
#ifdef __SANITIZE_THREAD__

#include <oneapi/tbb/detail/_small_object_pool.h>
#include <oneapi/tbb/detail/_task.h>

#include <dlfcn.h>
#include <sanitizer/tsan_interface.h>

#include <cstdlib>
#include <cstring>
#include <new>

namespace {

using tbb::detail::d1::execution_data;
using tbb::detail::d1::slot_id;
using tbb::detail::d1::small_object_pool;
using tbb::detail::d1::task;
using tbb::detail::d1::task_group_context;
using tbb::detail::d1::wait_context;

/// A task in the place of another, which it runs.
class Stand final : public task {
public:
    /// @return one that lives until it has run; made without operator new, which may be told to fail
    static Stand& make(task& real) {
        auto* stand = new (std::aligned_alloc(alignof(Stand), sizeof(Stand))) Stand(real);
        __tsan_release(&real);
        return *stand;
    }

    task* execute(execution_data& data) override {
        become();
        task* const next = mReal.execute(data); // if it throws, TBB cancels this
        vanish();
        return next;
    }
    task* cancel(execution_data& data) override {
        become();
        task* const next = mReal.cancel(data);
        vanish();
        return next;
    }

private:
    explicit Stand(task& real) : mReal(real) {}

    __attribute__((no_sanitize("thread"))) void become() {
        __tsan_acquire(&mReal);
        // What TBB knows of a task, which counts once one goes on as another: its context and isolation.
        constexpr std::size_t kVirtual = sizeof(void*), kKnown = sizeof(task) - kVirtual;
        std::memcpy(reinterpret_cast<char*>(&mReal) + kVirtual, reinterpret_cast<char*>(this) + kVirtual,
                    kKnown);
    }
    void vanish() {
        this->~Stand();
        std::free(this);
    }

    task& mReal;
};

template <typename Function>
Function* real(const char* name) {
    return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

/// Memory that another thread may have given back.
void* taken(void* memory) {
    __tsan_acquire(memory);
    return memory;
}

/// The counter of a wait_context, by which the header's inline code tells that tasks have ended.
void* counterOf(wait_context& wait) { return reinterpret_cast<char*>(&wait) + 8; }

} // namespace

namespace tbb::detail::r1 {

void spawn(task& t, task_group_context& context) {
    static auto* const next = real<void(task&, task_group_context&)>(
        "_ZN3tbb6detail2r15spawnERNS0_2d14taskERNS2_18task_group_contextE");
    next(Stand::make(t), context);
}

void spawn(task& t, task_group_context& context, slot_id slot) {
    static auto* const next = real<void(task&, task_group_context&, slot_id)>(
        "_ZN3tbb6detail2r15spawnERNS0_2d14taskERNS2_18task_group_contextEt");
    next(Stand::make(t), context, slot);
}

void execute_and_wait(task& t, task_group_context& context, wait_context& waiting,
                      task_group_context& waitContext) {
    static auto* const next = real<void(task&, task_group_context&, wait_context&, task_group_context&)>(
        "_ZN3tbb6detail2r116execute_and_waitERNS0_2d14taskERNS2_18task_group_contextERNS2_12wait_"
        "contextES6_");
    struct Acquire { // also where a task has thrown
        ~Acquire() { __tsan_acquire(counterOf(of)); }
        wait_context& of;
    } acquire{waiting};
    next(t, context, waiting, waitContext);
}

void wait(wait_context& waiting, task_group_context& context) {
    static auto* const next = real<void(wait_context&, task_group_context&)>(
        "_ZN3tbb6detail2r14waitERNS0_2d112wait_contextERNS2_18task_group_contextE");
    struct Acquire {
        ~Acquire() { __tsan_acquire(counterOf(of)); }
        wait_context& of;
    } acquire{waiting};
    next(waiting, context);
}

// Memory goes from thread to thread without the sanitizer's knowledge, too.

void* allocate(small_object_pool*& pool, std::size_t bytes, const execution_data& data) {
    static auto* const next = real<void*(small_object_pool*&, std::size_t, const execution_data&)>(
        "_ZN3tbb6detail2r18allocateERPNS0_2d117small_object_poolEmRKNS2_14execution_dataE");
    return taken(next(pool, bytes, data));
}

void* allocate(small_object_pool*& pool, std::size_t bytes) {
    static auto* const next = real<void*(small_object_pool*&, std::size_t)>(
        "_ZN3tbb6detail2r18allocateERPNS0_2d117small_object_poolEm");
    return taken(next(pool, bytes));
}

void deallocate(small_object_pool& pool, void* memory, std::size_t bytes, const execution_data& data) {
    static auto* const next = real<void(small_object_pool&, void*, std::size_t, const execution_data&)>(
        "_ZN3tbb6detail2r110deallocateERNS0_2d117small_object_poolEPvmRKNS2_14execution_dataE");
    __tsan_release(memory);
    next(pool, memory, bytes, data);
}

void deallocate(small_object_pool& pool, void* memory, std::size_t bytes) {
    static auto* const next = real<void(small_object_pool&, void*, std::size_t)>(
        "_ZN3tbb6detail2r110deallocateERNS0_2d117small_object_poolEPvm");
    __tsan_release(memory);
    next(pool, memory, bytes);
}

void* cache_aligned_allocate(std::size_t bytes) {
    static auto* const next = real<void*(std::size_t)>("_ZN3tbb6detail2r122cache_aligned_allocateEm");
    return taken(next(bytes));
}

void cache_aligned_deallocate(void* memory) {
    static auto* const next = real<void(void*)>("_ZN3tbb6detail2r124cache_aligned_deallocateEPv");
    __tsan_release(memory);
    next(memory);
}

} // namespace tbb::detail::r1

#endif
