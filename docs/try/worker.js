// Runs commands of delmesher, and verifies, one after the other. It is ended to cancel one.
import { Delmesher, Verifier } from "./delmesher.js";

onmessage = ({ data: { module, args, files, verify } }) => {
  const onProgress = (line) => postMessage({ progress: line });
  try {
    if (verify) {
      postMessage({ result: new Verifier(module).verify(verify.surface, verify.mesh, { promised: verify.promised, onProgress }) });
    } else {
      const result = new Delmesher(module).run(args, { files, onProgress });
      postMessage({ result }, Object.values(result.files).map((bytes) => bytes.buffer));
    }
  } catch (error) {
    postMessage({ result: { code: 6, out: "", error: error.message, files: {} } });
  }
};
