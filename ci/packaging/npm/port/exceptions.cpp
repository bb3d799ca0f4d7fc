// Exceptions of the Itanium C++ ABI on those of WebAssembly: Debian builds libc++abi for WASI
// without them, and without threads.
//
// What is thrown is a Thrown in front of the object. Clean-up needs no help; where a type is
// caught, the compiler calls _Unwind_CallPersonality, which looks into the table of the function
// (LSDA) for the clause.
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <new>
#include <typeinfo>

namespace {

struct alignas(16) Thrown {
  const std::type_info* type;
  void* (*destroy)(void*);  // destructors return the object here
  Thrown* outer;            // the one that was caught before, and still is
  int handlers;             // that hold it; negative while it is thrown again
  int references;           // a throw or the handlers count once, each std::exception_ptr once
  void* adjusted;           // the object, as the clause that was found sees it
  void* object() { return this + 1; }
};

Thrown* caught = nullptr;  // the innermost
int uncaught = 0;

Thrown* thrown_of(void* object) {
  return static_cast<Thrown*>(object) - 1;
}

void release(Thrown* thrown) {
  if (--thrown->references > 0) return;
  if (thrown->destroy != nullptr) thrown->destroy(thrown->object());
  std::free(thrown);
}

[[noreturn]] void throw_it(Thrown* thrown) {
  ++uncaught;
  __builtin_wasm_throw(0, thrown);
}

std::uintptr_t unsigned_leb(const std::uint8_t*& at) {
  std::uintptr_t value = 0;
  for (unsigned shift = 0;; shift += 7) {
    const std::uint8_t byte = *at++;
    value |= static_cast<std::uintptr_t>(byte & 0x7fU) << shift;
    if ((byte & 0x80U) == 0) return value;
  }
}

std::intptr_t signed_leb(const std::uint8_t*& at) {
  std::uintptr_t value = 0;
  for (unsigned shift = 0;;) {
    const std::uint8_t byte = *at++;
    value |= static_cast<std::uintptr_t>(byte & 0x7fU) << shift;
    shift += 7;
    if ((byte & 0x80U) != 0) continue;
    if ((byte & 0x40U) != 0 && shift < 32) value |= ~std::uintptr_t{0} << shift;
    return static_cast<std::intptr_t>(value);
  }
}

// The first functions of libc++abi's type information, which knows bases.
class TypeInfo : public std::type_info {
 public:
  ~TypeInfo() override;
  virtual void unused1() const;
  virtual void unused2() const;
  virtual bool can_catch(const TypeInfo* thrown, void*& adjusted) const = 0;
};

}  // namespace

extern "C" {

// Between the compiler's code and _Unwind_CallPersonality.
thread_local struct {
  std::uintptr_t lpad_index;  // which landing pad of the function
  const std::uint8_t* lsda;
  std::uintptr_t selector;  // the clause that catches; 0: none
} __wasm_lpad_context;

int __gxx_wasm_personality_v0(...) {
  std::abort();  // only named by the compiler
}

int _Unwind_CallPersonality(void* exception) {
  Thrown* thrown = static_cast<Thrown*>(exception);
  __wasm_lpad_context.selector = 0;
  const std::uint8_t* at = __wasm_lpad_context.lsda;
  constexpr std::uint8_t kOmitted = 0xff, kPointer = 0;
  if (*at++ != kOmitted) std::abort();  // no place where landing pads begin
  if (*at++ != kPointer) std::abort();  // how types are written
  const std::uintptr_t types_after = unsigned_leb(at);
  const std::uint8_t* types = at + types_after;
  ++at;  // how places of calls are written: there are none
  const std::uintptr_t pads_size = unsigned_leb(at);
  const std::uint8_t* actions = at + pads_size;
  for (std::uintptr_t n = 0; n < __wasm_lpad_context.lpad_index; ++n) {
    unsigned_leb(at);
    unsigned_leb(at);
  }
  unsigned_leb(at);
  const std::uintptr_t first = unsigned_leb(at);
  if (first == 0) return 0;
  for (const std::uint8_t* action = actions + first - 1;;) {
    const std::intptr_t clause = signed_leb(action);
    if (clause > 0) {
      const TypeInfo* type = reinterpret_cast<const TypeInfo* const*>(types)[-clause];
      void* adjusted = thrown->object();
      if (type == nullptr ||
          type->can_catch(static_cast<const TypeInfo*>(thrown->type), adjusted)) {
        thrown->adjusted = adjusted;
        __wasm_lpad_context.selector = static_cast<std::uintptr_t>(clause);
        return 0;
      }
    }
    const std::uint8_t* next = action;
    const std::intptr_t offset = signed_leb(next);
    if (offset == 0) return 0;
    action += offset;
  }
}

void* __cxa_allocate_exception(std::size_t size) noexcept {
  void* memory = std::aligned_alloc(alignof(Thrown), sizeof(Thrown) + (size + 15) / 16 * 16);
  if (memory == nullptr) std::terminate();
  return (new (memory) Thrown{})->object();
}

void __cxa_free_exception(void* object) noexcept {
  std::free(thrown_of(object));
}

[[noreturn]] void __cxa_throw(void* object, std::type_info* type, void* (*destroy)(void*)) {
  Thrown* thrown = thrown_of(object);
  thrown->type = type;
  thrown->destroy = destroy;
  thrown->references = 1;
  throw_it(thrown);
}

void* __cxa_get_exception_ptr(void* exception) noexcept {
  return static_cast<Thrown*>(exception)->adjusted;
}

void* __cxa_begin_catch(void* exception) noexcept {
  Thrown* thrown = static_cast<Thrown*>(exception);
  --uncaught;
  thrown->handlers = thrown->handlers < 0 ? 1 - thrown->handlers : 1 + thrown->handlers;
  if (thrown != caught) {
    thrown->outer = caught;
    caught = thrown;
  }
  return thrown->adjusted;
}

void __cxa_end_catch() {
  Thrown* thrown = caught;
  if (thrown->handlers < 0) {  // it is on its way again
    if (++thrown->handlers == 0) caught = thrown->outer;
  } else if (--thrown->handlers == 0) {
    caught = thrown->outer;
    release(thrown);
  }
}

[[noreturn]] void __cxa_rethrow() {
  if (caught == nullptr) std::terminate();
  caught->handlers = -caught->handlers;
  throw_it(caught);
}

// For std::exception_ptr.
void __cxa_increment_exception_refcount(void* object) noexcept {
  if (object != nullptr) ++thrown_of(object)->references;
}
void __cxa_decrement_exception_refcount(void* object) noexcept {
  if (object != nullptr) release(thrown_of(object));
}
void* __cxa_current_primary_exception() noexcept {
  if (caught == nullptr) return nullptr;
  ++caught->references;
  return caught->object();
}
void __cxa_rethrow_primary_exception(void* object) {
  if (object == nullptr) return;
  Thrown* thrown = thrown_of(object);
  if (thrown->handlers != 0)
    std::terminate();  // one that is being handled would need a second Thrown
  ++thrown->references;
  throw_it(thrown);
}

bool __cxa_uncaught_exception() noexcept {
  return uncaught > 0;
}
unsigned __cxa_uncaught_exceptions() noexcept {
  return static_cast<unsigned>(uncaught);
}

[[noreturn]] void __cxa_bad_cast() {
  throw std::bad_cast();
}
[[noreturn]] void __cxa_bad_typeid() {
  throw std::bad_typeid();
}
[[noreturn]] void __cxa_throw_bad_array_new_length() {
  throw std::bad_array_new_length();
}

// The end of the only thread is that of the program, and takes all memory with it.
int __cxa_thread_atexit(void (* /*destroy*/)(void*), void* /*object*/, void* /*of*/) {
  return 0;
}

}  // extern "C"

// libc++abi's would end the program where there is no memory left.
void* operator new(std::size_t size) {
  void* memory = std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto step = static_cast<std::size_t>(alignment);
  void* memory = std::aligned_alloc(step, (size + step - 1) / step * step);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
