// Runs commands of delmesher, one after the other. It is ended to cancel one.
import { Delmesher } from "./delmesher.js";

let delmesher;
onmessage = ({ data }) => {
  if (data.module) {
    delmesher = new Delmesher(data.module);
    return;
  }
  try {
    const result = delmesher.run(data.args, { files: data.files, onProgress: (line) => postMessage({ progress: line }) });
    postMessage({ result }, Object.values(result.files).map((bytes) => bytes.buffer));
  } catch (error) {
    postMessage({ result: { code: 6, out: "", error: `delmesher: ${error.message}\n`, files: {} } });
  }
};
