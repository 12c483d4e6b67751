import { render } from "preact";
import { App } from "./app";
import { findSource } from "./source";
import "./style.css";

const page = document.getElementById("page");
if (page) render(<App source={findSource()} />, page);
