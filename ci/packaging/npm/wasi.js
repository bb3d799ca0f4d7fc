// What a WebAssembly module for WASI (preview 1) asks of its host: arguments, a clock, and files, which are in memory.
const E = { badf: 8, exist: 20, inval: 28, isdir: 31, noent: 44, notdir: 54, notempty: 55 };
const kUnknown = 0, kCharacters = 2, kFolder = 3, kFile = 4;
const kRoot = 3;  // the file descriptor of "/", after those of the standard streams

class File {
  constructor(bytes = new Uint8Array(0)) {
    this.bytes = bytes;
    this.size = bytes.length;
  }
  write(from, at) {
    const end = at + from.length;
    if (end > this.bytes.length) {
      const more = new Uint8Array(Math.max(end, 2 * this.bytes.length, 65536));
      more.set(this.bytes.subarray(0, this.size));
      this.bytes = more;
    }
    this.bytes.set(from, at);
    this.size = Math.max(this.size, end);
  }
  content() {
    return this.bytes.slice(0, this.size);
  }
}

class Exit {
  constructor(code) {
    this.code = code;
  }
}

/** Files are { name: Uint8Array }; out and error get what the program writes; a terminal shows its progress. */
export class Wasi {
  constructor({ args, files = {}, out, error, terminal = false }) {
    this.args = args.map((text) => new TextEncoder().encode(text + "\0"));
    this.files = new Map(Object.entries(files).map(([name, bytes]) => [this.clean(name), new File(bytes)]));
    this.folders = new Set([""]);
    this.open = [null, null, null, { path: "" }];
    this.decoders = [null, { decoder: new TextDecoder(), take: out }, { decoder: new TextDecoder(), take: error }];
    this.terminal = terminal;
    this.imports = { wasi_snapshot_preview1: this.functions() };
  }

  /** Runs a command from its beginning to its end, and returns its exit code. */
  start(instance) {
    this.memory = instance.exports.memory;
    try {
      instance.exports._start();
      return 0;
    } catch (end) {
      if (end instanceof Exit) return end.code;
      throw end;
    }
  }

  clean(path) {
    return path.split("/").filter((part) => part !== "" && part !== ".").join("/");
  }
  view() {
    return new DataView(this.memory.buffer);
  }
  path(at, size) {
    return this.clean(new TextDecoder().decode(new Uint8Array(this.memory.buffer, at, size).slice()));
  }
  kind(path) {
    return this.files.has(path) ? kFile : this.folders.has(path) ? kFolder : undefined;
  }
  // Where something new would be: an error, or 0.
  missing_folder(path) {
    const folder = path.includes("/") ? path.slice(0, path.lastIndexOf("/")) : "";
    return this.folders.has(folder) ? 0 : this.files.has(folder) ? E.notdir : E.noent;
  }
  *pieces(at, count) {
    for (let n = 0; n < count; ++n) {
      const view = this.view();
      yield new Uint8Array(this.memory.buffer, view.getUint32(at + 8 * n, true), view.getUint32(at + 8 * n + 4, true));
    }
  }
  describe(at, kind, size) {
    const view = this.view();
    for (let k = 0; k < 64; k += 8) view.setBigUint64(at + k, 0n, true);
    view.setUint8(at + 16, kind);
    view.setBigUint64(at + 24, 1n, true);
    view.setBigUint64(at + 32, BigInt(size), true);
    return 0;
  }

  functions() {
    const size_of = (list) => list.reduce((sum, bytes) => sum + bytes.length, 0);
    return {
      args_sizes_get: (count, size) => {
        this.view().setUint32(count, this.args.length, true);
        this.view().setUint32(size, size_of(this.args), true);
        return 0;
      },
      args_get: (pointers, at) => {
        this.args.forEach((bytes, n) => {
          this.view().setUint32(pointers + 4 * n, at, true);
          new Uint8Array(this.memory.buffer).set(bytes, at);
          at += bytes.length;
        });
        return 0;
      },
      environ_sizes_get: (count, size) => {
        this.view().setUint32(count, 0, true);
        this.view().setUint32(size, 0, true);
        return 0;
      },
      environ_get: () => 0,
      clock_time_get: (clock, precision, at) => {
        const now = clock === 0 ? Date.now() : performance.now();
        this.view().setBigUint64(at, BigInt(Math.round(now * 1e6)), true);
        return 0;
      },
      random_get: () => 0,  // zeros: runs repeat
      proc_exit: (code) => {
        throw new Exit(code);
      },

      fd_close: (fd) => {
        if (fd > kRoot) delete this.open[fd];
        return 0;
      },
      fd_fdstat_get: (fd, at) => {
        const view = this.view(), stream = fd < kRoot;
        if (!stream && !this.open[fd]) return E.badf;
        view.setUint8(at, stream ? (this.terminal ? kCharacters : kUnknown) : fd === kRoot ? kFolder : kFile);
        view.setUint16(at + 2, 0, true);
        const rights = stream ? 2n | 64n : ~0n;  // streams: to read and to write
        view.setBigUint64(at + 8, BigInt.asUintN(64, rights), true);
        view.setBigUint64(at + 16, BigInt.asUintN(64, rights), true);
        return 0;
      },
      fd_fdstat_set_flags: () => 0,
      fd_prestat_get: (fd, at) => {
        if (fd !== kRoot) return E.badf;
        this.view().setUint32(at, 0, true);
        this.view().setUint32(at + 4, 1, true);
        return 0;
      },
      fd_prestat_dir_name: (fd, at) => {
        this.view().setUint8(at, "/".charCodeAt(0));
        return 0;
      },
      fd_sync: () => 0,
      fd_read: (fd, at, count, done) => {
        const open = this.open[fd];
        let size = 0;
        if (fd > 0 && !open?.file) return E.badf;
        for (const piece of fd > 0 ? this.pieces(at, count) : []) {
          const part = open.file.bytes.subarray(open.at, Math.min(open.file.size, open.at + piece.length));
          piece.set(part);
          open.at += part.length;
          size += part.length;
        }
        this.view().setUint32(done, size, true);
        return 0;
      },
      fd_write: (fd, at, count, done) => {
        let size = 0;
        const open = this.open[fd], stream = this.decoders[fd];
        if (!stream && !open?.file) return E.badf;
        for (const piece of this.pieces(at, count)) {
          if (stream) {
            const text = stream.decoder.decode(piece.slice(), { stream: true });
            if (text !== "") stream.take?.(text);
          } else {
            open.file.write(piece, open.at);
            open.at += piece.length;
          }
          size += piece.length;
        }
        this.view().setUint32(done, size, true);
        return 0;
      },
      fd_seek: (fd, offset, whence, at) => {
        const open = this.open[fd];
        if (!open?.file) return E.badf;
        const to = Number(offset) + (whence === 0 ? 0 : whence === 1 ? open.at : open.file.size);
        if (to < 0) return E.inval;
        open.at = to;
        this.view().setBigUint64(at, BigInt(to), true);
        return 0;
      },

      path_open: (fd, follow, at, size, flags, rights, inheriting, fdflags, opened) => {
        const path = this.path(at, size);
        const [create, folder, exclusive, truncate] = [1, 2, 4, 8].map((flag) => (flags & flag) !== 0);
        const kind = this.kind(path);
        if (kind !== undefined && create && exclusive) return E.exist;
        if (kind === kFolder && (rights & 64n) !== 0n) return E.isdir;
        if (kind === kFile && folder) return E.notdir;
        if (kind === undefined) {
          if (!create) return E.noent;
          if (this.missing_folder(path)) return this.missing_folder(path);
          this.files.set(path, new File());
        } else if (truncate) {
          this.files.set(path, new File());
        }
        this.open.push({ path, file: this.files.get(path), at: 0 });
        this.view().setUint32(opened, this.open.length - 1, true);
        return 0;
      },
      path_filestat_get: (fd, follow, at, size, found) => {
        const path = this.path(at, size), kind = this.kind(path);
        return kind === undefined ? E.noent : this.describe(found, kind, kind === kFile ? this.files.get(path).size : 0);
      },
      path_create_directory: (fd, at, size) => {
        const path = this.path(at, size);
        if (this.kind(path) !== undefined) return E.exist;
        if (this.missing_folder(path)) return this.missing_folder(path);
        this.folders.add(path);
        return 0;
      },
      path_remove_directory: (fd, at, size) => {
        const path = this.path(at, size);
        if (!this.folders.has(path)) return E.noent;
        if ([...this.files.keys(), ...this.folders].some((other) => other.startsWith(path + "/"))) return E.notempty;
        this.folders.delete(path);
        return 0;
      },
      path_unlink_file: (fd, at, size) => {
        const path = this.path(at, size);
        if (!this.files.delete(path)) return this.folders.has(path) ? E.isdir : E.noent;
        return 0;
      },
      path_rename: (fd, at, size, to_fd, to_at, to_size) => {
        const from = this.path(at, size), to = this.path(to_at, to_size);
        if (!this.files.has(from)) return E.noent;
        if (this.folders.has(to)) return E.isdir;
        if (this.missing_folder(to)) return this.missing_folder(to);
        const file = this.files.get(from);
        this.files.delete(from);
        this.files.set(to, file);
        return 0;
      },
    };
  }
}
